//! The one table of quantities, from which results pane, text, JSON, CSV, limits and `--only` are
//! derived.

use super::inputs::Method;
use super::{Solution, Stage};

/// A result with a name.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// The name in JSON, in `--only` and in `[limits]`.
    pub key: &'static str,
    /// The symbol in the field's writing.
    pub symbol: &'static str,
    /// A few words for a person.
    pub label: &'static str,
    /// The SI unit, "1" for a number.
    pub unit: &'static str,
    /// The unit in which a person reads it.
    pub shown: &'static str,
    /// Significant digits that a person reads.
    pub digits: usize,
    /// Where the formula stands.
    pub equation: &'static str,
    /// The last stage that it needs.
    pub stage: Stage,
    /// The value in SI, where there is one.
    pub value: fn(&Solution) -> Option<f64>,
}

impl Quantity {
    /// Whether it is true (1) or false (0).
    #[must_use]
    pub fn is_flag(&self) -> bool {
        self.shown == "yes/no"
    }

    /// Whether there is nothing of it without a friction coefficient.
    #[must_use]
    pub fn needs_friction(&self) -> bool {
        matches!(self.key, "pitch_contact_jump" | "dynamic_friction_work")
    }

    /// The symbol in a method: where the method defines the quantity otherwise than the closed form
    /// does, another one.
    #[must_use]
    pub fn symbol_in(&self, method: Method) -> &'static str {
        if self.leaves_reliefs_out(method) {
            "Δf_0"
        } else {
            self.symbol
        }
    }

    /// A few words for a person, as the method defines the quantity.
    #[must_use]
    pub fn label_in(&self, method: Method) -> &'static str {
        if self.leaves_reliefs_out(method) {
            "error without reliefs"
        } else {
            self.label
        }
    }

    // In `static` and `dynamic` the reliefs act on the flanks, and are no part of Δf.
    fn leaves_reliefs_out(&self, method: Method) -> bool {
        self.key == "equivalent_error" && method.shares_load()
    }

    /// Whether it is of the free impact at D: the closed form, which every method has beside its
    /// own results.
    #[must_use]
    pub fn is_of_free_impact(&self) -> bool {
        FREE_IMPACT.contains(&self.stage)
    }

    /// What a method itself finds in place of a quantity of the free impact; the quantity where the
    /// method is the closed form.
    #[must_use]
    pub fn by(&'static self, method: Method) -> Option<&'static Quantity> {
        let at = match method {
            Method::Paper | Method::Exact => return Some(self),
            Method::Static => 1,
            Method::Dynamic => 2,
            Method::Auto => return None,
        };
        let row = RESOLVED
            .iter()
            .find(|[free, ..]| self.key == *free || self.key.starts_with(&format!("{free}_")))?;
        Quantity::find(row[at])
    }

    /// The quantity of that name.
    #[must_use]
    pub fn find(key: &str) -> Option<&'static Quantity> {
        QUANTITIES.iter().find(|quantity| quantity.key == key)
    }

    /// The quantity of that key, or of that symbol in some method.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Quantity> {
        let has_symbol = |quantity: &&Quantity| {
            let mut symbols = Method::ALL
                .map(|method| quantity.symbol_in(method))
                .into_iter();
            symbols.any(|symbol| symbol == name)
        };
        Quantity::find(name).or_else(|| QUANTITIES.iter().find(has_symbol))
    }
}

/// The stages of the free impact at D.
const FREE_IMPACT: [Stage; 7] = [
    Stage::Position,
    Stage::Velocity,
    Stage::Compliance,
    Stage::Impact,
    Stage::Friction,
    Stage::Band,
    Stage::Stations,
];

/// A quantity of the free impact and its counterparts in `static` and `dynamic`; empty where a
/// method has none. A suffixed key such as `impact_force_low` is a variant of the same quantity.
const RESOLVED: [[&str; 3]; 4] = [
    [
        "approach_angle_driven",
        "static_first_contact_angle",
        "dynamic_first_contact_angle",
    ],
    [
        "approach_angle_driver",
        "static_first_contact_angle_driver",
        "dynamic_first_contact_angle_driver",
    ],
    [
        "impact_force",
        "static_force_at_start",
        "dynamic_peak_approach_force",
    ],
    ["impact_duration", "", "dynamic_impact_duration"],
];

macro_rules! quantity {
    ($key:literal, $symbol:literal, $label:literal, $unit:literal, $shown:literal, $digits:literal, $equation:literal, $stage:ident, $value:expr) => {
        Quantity {
            key: $key,
            symbol: $symbol,
            label: $label,
            unit: $unit,
            shown: $shown,
            digits: $digits,
            equation: $equation,
            stage: Stage::$stage,
            value: $value,
        }
    };
}

/// The driver's angle over the same arc of the base circles, in rad.
fn of_driver(solution: &Solution, angle_driven: f64) -> f64 {
    angle_driven * solution.geometry.driven.base / solution.geometry.driver.base
}

/// Every quantity, in the order a person reads them.
#[rustfmt::skip]
pub static QUANTITIES: &[Quantity] = &[
    quantity!("contact_ratio", "ε", "contact ratio", "1", "1", 5, "ISO 21771", Geometry, |s| Some(s.geometry.contact_ratio)),
    quantity!("base_pitch", "p_b", "base pitch", "m", "mm", 6, "ISO 21771", Geometry, |s| Some(s.geometry.base_pitch)),
    quantity!("centre_distance", "a", "centre distance", "m", "mm", 6, "ISO 21771", Geometry, |s| Some(s.geometry.centre_distance)),
    quantity!("working_pressure_angle", "α_w", "working pressure angle", "rad", "deg", 6, "ISO 21771", Geometry, |s| Some(s.geometry.working_pressure_angle)),
    quantity!("mesh_force", "F_0", "mesh force", "N", "N", 5, "T1/rb1", Load, |s| Some(s.mesh_force)),
    quantity!("equivalent_error", "Δf", "equivalent error", "m", "um", 5, "Eq. 1", Deviation, |s| Some(s.deviation.equivalent_error)),
    quantity!("modification", "e_m", "modification at run-in", "m", "um", 5, "Eq. 1", Deviation, |s| Some(s.deviation.modification)),
    quantity!("combined_deflection", "δ", "combined deflection", "m", "um", 5, "Eq. 3", Deviation, |s| Some(s.deviation.combined_deflection)),
    quantity!("total_deviation", "Δ", "total deviation", "m", "um", 5, "Eq. 5", Deviation, |s| Some(s.deviation.total)),
    quantity!("clearing_relief", "ΔC_a2", "additional tip relief", "m", "um", 5, "no touch before E", Clearing, |s| s.clearing?.relief),
    quantity!("approach_angle_driver", "θ_1", "driver angle before E", "rad", "deg", 6, "Eq. 12", Position, |s| Some(s.position?.approach_angle_driver)),
    quantity!("approach_angle_driven", "u", "driven angle before E", "rad", "deg", 6, "Eq. 11", Position, |s| Some(s.position?.approach_angle_driven)),
    quantity!("contact_radius_driver", "O1D", "driver radius at D", "m", "mm", 6, "Eq. 7", Position, |s| Some(s.position?.contact.radius_driver)),
    quantity!("contact_normal_radius_driven", "r_b2'", "normal's radius, driven", "m", "mm", 6, "Eq. 49", Position, |s| Some(s.position?.contact.normal_radius_driven)),
    quantity!("curvature_radius", "ρ_S", "radius of curvature", "m", "mm", 5, "Eq. 32", Position, |s| Some(s.position?.curvature_radius)),
    quantity!("closed_gap", "S(u)", "gap closed by the tip", "m", "um", 5, "S(u) = Δ", Position, |s| Some(s.position?.closed_gap)),
    quantity!("transit_time", "t_DE", "time from D to E", "s", "us", 5, "u/ω2", Velocity, |s| Some(s.velocity?.transit_time)),
    quantity!("normal_velocity", "ΔV_n", "approach velocity at D", "m/s", "m/s", 5, "Eq. 21", Velocity, |s| Some(s.velocity?.normal)),
    quantity!("sliding_velocity", "ΔV_τ", "sliding velocity at D", "m/s", "m/s", 5, "Eq. 22", Velocity, |s| Some(s.velocity?.sliding)),
    quantity!("impact_force", "F_S", "impact force", "N", "N", 5, "Eq. 57", Impact, |s| Some(s.impact?.force)),
    quantity!("impact_force_low", "F_S,low", "  stiffness band from", "N", "N", 4, "models in range", Band, |s| Some(s.band?.low)),
    quantity!("impact_force_high", "F_S,high", "  stiffness band to", "N", "N", 4, "models in range", Band, |s| Some(s.band?.high)),
    quantity!("dynamic_factor", "F_S/F_0", "dynamic factor", "1", "1", 4, "F_S/F_0", Impact, |s| Some(s.impact?.force / s.mesh_force)),
    quantity!("impact_duration", "T_S", "impact duration", "s", "us", 4, "by the method", Impact, |s| Some(s.impact?.duration)),
    quantity!("impact_duration_printed", "T_S,32", "  by Eq. 32 as printed", "s", "us", 4, "Eq. 32", Impact, |s| Some(s.impact?.duration_printed)),
    quantity!("impact_duration_hertz", "T_S,H", "  with Hertz's prefactor", "s", "us", 4, "Hertz 1882", Impact, |s| Some(s.impact?.duration_hertz)),
    quantity!("impact_duration_spring", "T_S,q", "  of the model's spring", "s", "us", 4, "π√(Mq/b)", Impact, |s| Some(s.impact?.duration_spring)),
    quantity!("reduced_mass", "m_red", "reduced mass", "kg", "kg", 5, "Eq. 33", Load, |s| Some(s.reduced_mass)),
    quantity!("effective_mass", "M", "effective mass at D", "kg", "kg", 5, "Eq. 50", Impact, |s| Some(s.impact?.effective_mass)),
    quantity!("pair_compliance", "q_s", "pair compliance", "m2/N", "um mm/N", 5, "Eq. 54", Impact, |s| Some(s.impact?.pair_compliance)),
    quantity!("hertz_half_width", "a_H", "Hertz half-width", "m", "um", 5, "Eq. 55", Impact, |s| Some(s.impact?.hertz_half_width)),
    quantity!("impact_energy", "E_k", "impact energy", "J", "J", 5, "Eq. 50", Impact, |s| Some(s.impact?.energy)),
    quantity!("sliding_energy", "W_f", "sliding energy", "J", "J", 5, "Eq. 51", Impact, |s| Some(s.impact?.sliding_energy)),
    quantity!("friction_ratio", "f", "friction ratio", "1", "1", 4, "Eq. 64", Friction, |s| s.friction?.ratio),
    quantity!("stick_limit", "μ_stick", "stick limit", "1", "1", 4, "ΔVτ/(2ΔVn)", Velocity, |s| Some(s.velocity?.stick_limit)),
    quantity!("impulse_ratio", "κ", "impulse ratio", "1", "1", 4, "(2/π)F_S·T_S/(M·ΔV_n)", Impact, |s| Some(s.impact?.impulse_ratio)),
    quantity!("mesh_stiffness", "k_m", "mean mesh stiffness", "N/m", "N/um", 5, "mean of b/q", Mesh, |s| Some(s.mesh.as_ref()?.mean_stiffness)),
    quantity!("static_first_contact_angle_driver", "θ_st", "static: driver before E", "rad", "deg", 6, "ΣF = F0", Static, |s| Some(of_driver(s, s.static_load.as_ref()?.first_contact_angle?))),
    quantity!("static_first_contact_angle", "u_st", "static: driven before E", "rad", "deg", 6, "ΣF = F0", Static, |s| s.static_load.as_ref()?.first_contact_angle),
    quantity!("static_force_at_start", "F_st,E", "static: force at E", "N", "N", 5, "ΣF = F0", Static, |s| Some(s.static_load.as_ref()?.force_at_start)),
    quantity!("static_peak_force", "F_st,max", "static: peak force", "N", "N", 5, "ΣF = F0", Static, |s| Some(s.static_load.as_ref()?.peak_force)),
    quantity!("static_last_contact_angle", "θ_st,B", "static: driver after B", "rad", "deg", 6, "ΣF = F0", Static, |s| s.static_load.as_ref()?.last_contact_angle),
    quantity!("static_transmission_error", "TE_st", "transmission error", "m", "um", 5, "max x − min x", Static, |s| Some(s.static_load.as_ref()?.transmission_error)),
    quantity!("pitch_contact_jump", "ΔF_P", "jump at the pitch point", "N", "N", 4, "μ reverses", Static, |s| s.static_load.as_ref()?.pitch_jump),
    quantity!("dynamic_first_contact_angle_driver", "θ_d", "dynamic: driver before E", "rad", "deg", 6, "m x'' + ΣF = F0", Dynamic, |s| Some(of_driver(s, s.dynamic.as_ref()?.first_contact_angle?))),
    quantity!("dynamic_first_contact_angle", "u_d", "dynamic: driven before E", "rad", "deg", 6, "m x'' + ΣF = F0", Dynamic, |s| s.dynamic.as_ref()?.first_contact_angle),
    quantity!("dynamic_peak_approach_force", "F_d,DE", "dynamic: peak before E", "N", "N", 5, "m x'' + ΣF = F0", Dynamic, |s| Some(s.dynamic.as_ref()?.peak_approach_force)),
    quantity!("dynamic_peak_force", "F_d,max", "dynamic: peak force", "N", "N", 5, "m x'' + ΣF = F0", Dynamic, |s| Some(s.dynamic.as_ref()?.peak_force)),
    quantity!("dynamic_impact_duration", "T_d", "dynamic: impact duration", "s", "us", 4, "m x'' + ΣF = F0", Dynamic, |s| s.dynamic.as_ref()?.impact_duration),
    quantity!("dynamic_last_contact_angle", "θ_d,B", "dynamic: driver after B", "rad", "deg", 6, "m x'' + ΣF = F0", Dynamic, |s| s.dynamic.as_ref()?.last_contact_angle),
    quantity!("dynamic_contact_lost", "lost", "dynamic: contact lost", "1", "yes/no", 1, "no pair touches", Dynamic, |s| Some(f64::from(u8::from(s.dynamic.as_ref()?.contact_lost)))),
    quantity!("dynamic_friction_work", "W_μ", "dynamic: friction work", "J", "J", 5, "∫μ F |v| dt", Dynamic, |s| s.dynamic.as_ref()?.friction_work),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_symbols_differ_by_case_alone() {
        let symbols = |quantity: &'static Quantity| {
            Method::ALL.map(|method| (quantity.key, quantity.symbol_in(method)))
        };
        let symbols: Vec<_> = QUANTITIES.iter().flat_map(symbols).collect();
        let stem = |symbol: &'static str| symbol.split(',').next().unwrap_or_default();
        for (key, symbol) in &symbols {
            let clash = |(_, theirs): &&(&str, &'static str)| {
                stem(theirs) != stem(symbol) && stem(theirs).eq_ignore_ascii_case(stem(symbol))
            };
            assert_eq!(symbols.iter().find(clash), None, "{key} {symbol}");
            assert_eq!(
                Quantity::named(symbol).map(|found| found.key),
                Some(*key),
                "{symbol}"
            );
        }
    }
}
