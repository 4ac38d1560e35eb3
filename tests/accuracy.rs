//! How accurate every closed-form quantity is, over the whole envelope, against an oracle of 90 digits.

mod oracle;

#[path = "oracle/envelope.rs"]
mod envelope;

use std::time::Instant;
use envelope::{Corner, Random, pair};
use tipstrike::model::{Quantity, Stages, solve, Inputs};

#[test]
fn explore() {
    let n: usize = std::env::var("N").ok().and_then(|n| n.parse().ok()).unwrap_or(40);
    let mut random = Random::new(std::env::var("SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(1));
    for corner in Corner::ALL {
        let (mut none, mut some) = (0, 0);
        let start = Instant::now();
        let mut worst: std::collections::BTreeMap<&str, (f64, f64, f64, f64)> = Default::default();
        while some < n {
            let inputs = pair(&mut random, corner);
            let Some((answers, conditions)) = oracle::answers_with_conditions(&inputs) else { none += 1; if none > 50 * n { break };
                let s = solve(&inputs, Stages::CLOSED_FORM);
                if s.as_ref().is_ok_and(|s| s.position.is_some()) { println!("{corner:?} oracle none, model {s:?} {inputs:?}"); }
                continue };
            for (key, v) in conditions.iter() { if oracle::number::rounded(&answers[key]).abs() < 1e-300 { println!("{key} zero {v}"); } }
            some += 1;
            for accurate in [false, true] {
                let inputs = Inputs { accurate, ..inputs.clone() };
                let solution = match solve(&inputs, Stages::CLOSED_FORM) { Ok(s) => s, Err(e) => { println!("{corner:?} refused {e} {inputs:?}"); continue } };
                for (key, value) in &answers {
                    let Some(found) = (Quantity::find(key).unwrap().value)(&solution) else { if !accurate { println!("{corner:?} absent {key} {:?} {:?} {:?}", solution.withheld, inputs.rung, inputs.contact_compliance); } continue };
                    let v = oracle::number::rounded(value);
                    let off = if v == 0.0 { found.abs() } else { oracle::number::rounded(&((oracle::number::big(found) - value) / value)).abs() };
                    let cond = conditions[key];
                    let w = worst.entry(key).or_default();
                    let rel = off / (2.2e-16 * (1.0 + cond));
                    if accurate { w.2 = w.2.max(off); w.3 = w.3.max(rel) } else { w.0 = w.0.max(off); w.1 = w.1.max(rel) }
                }
            }
        }
        println!("{corner:?}: {some} of {} in {:?}", some + none, start.elapsed());
        for (key, (a, b, c, d)) in worst { println!("   {key:30} default {a:.1e} /cond {b:8.1}   accurate {c:.1e} /cond {d:8.1}"); }
    }
}
