//! Default quantities of a study.

use crate::case::Case;
use crate::model::Quantity;
use crate::model::inputs::Method;

/// The limited quantities of a case, otherwise the impact force; each with its counterparts in the
/// methods that resolve the impact.
#[must_use]
pub fn headline(case: &Case, methods: &[Method]) -> Vec<&'static Quantity> {
    let limited: Vec<&Quantity> = case
        .limits
        .iter()
        .filter(|limit| !limit.text.is_empty())
        .filter_map(|limit| Quantity::find(limit.quantity))
        .collect();
    if limited.is_empty() {
        let force = Quantity::find("impact_force");
        return distinct(force.into_iter().flat_map(|force| in_methods(force, methods)));
    }
    let with_counterparts = |quantity: &'static Quantity| {
        let counterparts = in_methods(quantity, methods);
        std::iter::once(quantity).chain(counterparts)
    };
    distinct(limited.into_iter().flat_map(with_counterparts))
}

/// The counterpart of a quantity of the free impact in each method; for `auto`, in each method that
/// `auto` may choose.
fn in_methods(quantity: &'static Quantity, methods: &[Method]) -> Vec<&'static Quantity> {
    let single = |method: &Method| match method {
        Method::Auto => vec![Method::Exact, Method::Static, Method::Dynamic],
        one => vec![*one],
    };
    let all = methods.iter().flat_map(single);
    all.filter_map(|method| quantity.by(method)).collect()
}

/// Quantities without duplicates, in the order of their first occurrence.
#[must_use]
pub fn distinct(quantities: impl IntoIterator<Item = &'static Quantity>) -> Vec<&'static Quantity> {
    let mut found: Vec<&'static Quantity> = Vec::new();
    for quantity in quantities {
        if found.iter().all(|known| known.key != quantity.key) {
            found.push(quantity);
        }
    }
    found
}
