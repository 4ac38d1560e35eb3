//! Accuracy of every closed-form quantity over the whole envelope, compared with an oracle of 90
//! digits.
//!
//! `TIPSTRIKE_REGENERATE=1 cargo test --test core accuracy::regenerate` computes the frozen rows
//! and the table again. `TIPSTRIKE_PAIRS=1000000` checks twenty times as many new pairs, and
//! `TIPSTRIKE_SEED` repeats the pairs of an earlier run.
use crate::oracle;

use crate::envelope::{self, Corner, Random};
mod naive;
mod rows;
mod table;

use std::sync::LazyLock;

use crate::support::value;
use oracle::number::{Big, big, decimal, rounded};
use rows::Row;
use tipstrike::model::{Inputs, Refusal, Stages, solve};
use tipstrike::numeric::Real;
use twofloat::TwoFloat;

/// Half a unit in the last place of a double.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Promised relative error of the default path for well-conditioned problems.
const DEFAULT: f64 = 1e-12;
/// Promised relative error of the accurate path for well-conditioned problems.
const ACCURATE: f64 = 1e-13;
/// Greatest relative error of the default path for any problem.
const NEVER_WORSE: f64 = 1e-9;
/// Allowed error of an ill-conditioned quantity, as a multiple of the effect of rounding the
/// inputs.
const AMPLIFICATION: f64 = 4.0;

fn regenerating() -> bool {
    std::env::var_os("TIPSTRIKE_REGENERATE").is_some()
}

/// The greatest errors of a path.
#[derive(Debug, Default)]
struct Worst {
    off: f64,
    place: String,
    beyond: Vec<String>,
}

impl Worst {
    /// Fails with the quantities that exceed their allowed error, if any.
    fn assert_none_beyond(&self) {
        let first = &self.beyond[..self.beyond.len().min(8)];
        assert!(first.is_empty(), "{} {}", self.beyond.len(), first.join("\n"));
    }

    fn meet(&mut self, off: f64, place: impl FnOnce() -> String) {
        if off > self.off {
            (self.off, self.place) = (off, place());
        }
    }
}

/// Compares the quantities of one pair by one path with the oracle.
///
/// The relative error of a quantity may be the promise of the path. If the quantity is
/// ill-conditioned, so that rounding the inputs to doubles changes it by more, the error may be
/// four times this change: ROUNDING x the sum over all inputs of the relative change of the
/// quantity over the relative change of the input.
fn hold(row: &Row, accurate: bool, worst: &mut Worst) {
    let inputs = Inputs { accurate, ..row.inputs.clone() };
    let solution =
        solve(&inputs, row.stages()).unwrap_or_else(|refusal| panic!("{refusal}: {inputs:?}"));
    for key in row.answers.keys() {
        let found = value(&solution, key)
            .unwrap_or_else(|| panic!("no {key}, {:?}: {inputs:?}", solution.withheld));
        let (off, condition) = (row.off(key, found), row.conditions[key]);
        let (corner, delta) = (row.corner, solution.deviation.total);
        let place = || format!("{key}, condition {condition:e}, {corner:?}, Delta {delta:e} m");
        worst.meet(off, place);
        let promised = if accurate { ACCURATE } else { DEFAULT };
        let bound = promised.max(AMPLIFICATION * ROUNDING * condition);
        if off > bound {
            worst.beyond.push(format!("off by {off:e}, above {bound:e}: {}, {inputs:?}", place()));
        }
    }
}

#[test]
fn every_frozen_row_within_its_bound() {
    let rows = rows::frozen();
    assert!(rows.len() >= 800, "{} rows", rows.len());
    for accurate in [false, true] {
        let mut worst = Worst::default();
        for row in &rows {
            hold(row, accurate, &mut worst);
        }
        println!("accurate {accurate}: worst {:e}: {}", worst.off, worst.place);
        worst.assert_none_beyond();
        assert!(worst.off < NEVER_WORSE, "off by {:e}: {}", worst.off, worst.place);
    }
}

#[test]
fn frozen_rows_cover_every_quantity_and_decade() {
    let rows = rows::frozen();
    let keys = "approach_angle_driven sliding_velocity impact_force friction_ratio impulse_ratio";
    for key in keys.split(' ') {
        let count = rows.iter().filter(|row| row.answers.contains_key(key)).count();
        assert!(count > 300, "{key} is in {count} rows");
    }
    for decade in -15..=-4 {
        let count = rows.iter().filter(|row| table::decade(row) == decade).count();
        assert!(count >= 15, "decade {decade} has {count} rows");
    }
}

/// Compares model and oracle on pairs that are not frozen; `TIPSTRIKE_SEED` selects other pairs.
#[test]
fn fresh_pairs_within_their_bounds() {
    let pairs_per_corner = std::env::var("TIPSTRIKE_PAIRS")
        .map_or(2, |pairs| pairs.parse::<usize>().expect("a count") / 25_000);
    let seed = std::env::var("TIPSTRIKE_SEED").map_or(2014, |seed| seed.parse().expect("a seed"));
    println!("TIPSTRIKE_SEED={seed}");
    let mut random = Random::new(seed);
    let (mut worst, mut worst_accurate) = (Worst::default(), Worst::default());
    for corner in Corner::ALL {
        let mut left = pairs_per_corner;
        while left > 0 {
            let inputs = envelope::pair(&mut random, corner);
            // The oracle knows no tooth that its relief takes away.
            if matches!(solve(&inputs, Stages::CLOSED_FORM), Err(Refusal::ReliefTooLarge { .. })) {
                continue;
            }
            let Some(row) = Row::of(corner, inputs.clone()) else {
                let position =
                    solve(&inputs, Stages::CLOSED_FORM).ok().and_then(|solution| solution.position);
                assert!(position.is_none(), "{seed} {inputs:?}");
                continue;
            };
            hold(&row, false, &mut worst);
            hold(&row, true, &mut worst_accurate);
            left -= 1;
        }
    }
    println!("default: worst {:e}: {}", worst.off, worst.place);
    println!("accurate: worst {:e}: {}", worst_accurate.off, worst_accurate.place);
    worst.assert_none_beyond();
    worst_accurate.assert_none_beyond();
}

/// On request it freezes the rows again. Otherwise it computes the first row of each corner again
/// and compares it with the frozen one.
#[test]
fn regenerate() {
    if regenerating() {
        rows::regenerate();
        table::freeze();
        return;
    }
    let frozen = rows::frozen();
    for corner in Corner::ALL {
        let made = rows::rows_of(corner, 1);
        let first = frozen.iter().find(|row| row.corner == corner).expect("a row of the corner");
        assert_eq!(made[0].answers, first.answers, "{corner:?}");
        assert_eq!(made[0].inputs, first.inputs, "{corner:?}");
    }
}

/// The table of the frozen rows, computed once.
static MADE: LazyLock<table::Table> = LazyLock::new(|| table::Table::made(&rows::frozen()));

/// `cargo test --test core accuracy::table -- --nocapture` prints the table of docs/accuracy.md.
#[test]
fn table_of_errors_is_the_stored_one() {
    println!("{}", MADE.markdown());
    if !regenerating() {
        table::Table::stored().agrees_with(&MADE);
    }
}

#[test]
fn printed_forms_lose_digits_and_tipstrike_does_not() {
    for quantity in ["S", "u", "ΔV_n", "F_S"] {
        let (naive, ours) = MADE.median_at(quantity, -12);
        assert!(naive > 1e6 * ours, "{quantity}: naive {naive:e}, ours {ours:e}");
    }
}

/// Compares the oracle with published constants (NIST DLMF; Abramowitz & Stegun).
#[test]
fn oracle_knows_printed_constants() {
    let printed = [
        (oracle::number::pi(), "3.141592653589793238462643383279502884197169399375"),
        (big(2.0).ln(), "0.693147180559945309417232121458176568075500134360"),
        (big(1.0).exp(), "2.718281828459045235360287471352662497757247093700"),
        (big(1.0).sin(), "0.841470984807896506652502321630298999622563060798"),
        (big(3.0).atan2(&big(4.0)), "0.643501108793284386802809228717322638041510591115"),
    ];
    for (found, printed) in printed {
        let expected = decimal(printed);
        let off = rounded(&(&found / &expected - 1)).abs();
        assert!(off < 1e-46, "{printed}: off by {off:e}");
    }
    assert_eq!(oracle::number::printed(&decimal("-9.99e-7")), "-9.99e-7");
    assert_eq!(oracle::number::printed(&big(1000.0)), "1e3");
}

/// Checks the arithmetic of the accurate path.
#[test]
fn double_double_functions_keep_thirty_digits() {
    let exact = |x: TwoFloat| big(x.hi()) + big(x.lo());
    let close = |name: &str, found: TwoFloat, expected: &Big, scale: f64| {
        let off = rounded(&(exact(found) - expected)).abs() / scale.max(rounded(expected).abs());
        assert!(off < 3e-31, "{name} is off by {off:e}");
    };
    let mut random = Random::new(7);
    for _ in 0..300 {
        let (x, y) = (random.decades(1e-12, 1.5), random.decades(1e-6, 1e6));
        let (x, y) =
            (TwoFloat::new_add(x, x * random.even(-1e-17, 1e-17)), TwoFloat::new_mul(y, y.sqrt()));
        let (sine, cosine) = x.sine_cosine();
        close("sine", sine, &exact(x).sin(), 0.0);
        close("cosine", cosine, &exact(x).cos(), 0.0);
        close("quotient", x.over(y), &(exact(x) / exact(y)), 0.0);
        close("angle", x.angle_to(y), &exact(x).atan2(&exact(y)), 0.0);
        close("angle behind", x.angle_to(-y), &exact(x).atan2(&-exact(y)), 0.0);
        close("angle below", (-x).angle_to(y), &(-exact(x)).atan2(&exact(y)), 0.0);
    }
}
