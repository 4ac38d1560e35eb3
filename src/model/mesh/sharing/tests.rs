//! Shares against the compliance matrix at single places.

use super::*;
use crate::model::inputs::{Inputs, Method};
use crate::model::sample::standard_pair;
use crate::model::{Stage, Stages, solve};

/// Whatever touches, a line is what the same pairs do by their compliance matrix at each place.
#[test]
fn lines_are_the_forces_and_overlaps_by_the_compliance_matrix() {
    for (teeth, friction, deviation) in [(20, 0.0, 0.0), (60, 0.0, 12e-6), (150, 0.1, 12e-6)] {
        let inputs = Inputs {
            method: Method::Static,
            friction_coefficient: Some(friction),
            base_pitch_deviation: deviation,
            ..standard_pair(teeth, teeth, 3e-3)
        };
        let mesh = solve(&inputs, Stages::of(Stage::Static)).unwrap().mesh.unwrap();
        let borders = mesh.borders(0.0, mesh.base_pitch);
        for ends in borders.windows(2) {
            let (s, inside) = (0.7 * ends[0] + 0.3 * ends[1], f64::midpoint(ends[0], ends[1]));
            let pairs = mesh.pair_set(s, inside);
            let (x, balance) = pairs.shared(mesh.force);
            let touches = |pair: &usize| balance[*pair] > 0.0;
            let touching = (0..balance.len()).filter(touches);
            let touching = touching.fold(Touching::NONE, Touching::with);
            let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0);
            let meeting = Meeting {
                zones: mesh.standing(inside).map(|(_, zone)| zone).collect(),
                touching,
                deviating: incoming.filter(|&pair| touching.has(pair)),
            };
            let shares = mesh.shares(&meeting);
            let first = f64::from(pairs.pairs()[0].ahead) * mesh.base_pitch;
            let at = |of: Of, x: f64| {
                let line = shares.at(of, s + first);
                let apart = of.index() > 0 && incoming == Some(of.index() - 1);
                let error = if apart && meeting.deviating.is_none() { mesh.error } else { 0.0 };
                line.slope * x - line.offset + line.deviated.unwrap_or(0.0) * mesh.error + error
            };
            for x in [0.6 * x, 1.7 * x] {
                let (leads, mut sum) = (pairs.leads(touching, x), 0.0);
                for (index, pair) in pairs.pairs().iter().enumerate() {
                    let found = at(Of::Pair(index), x);
                    let (expected, size) = if touching.has(index) {
                        let force = leads[index] * pair.stiffness;
                        sum += pair.weight * force;
                        (force, mesh.force)
                    } else {
                        (leads[index], x.abs().max(pair.gap.abs()))
                    };
                    let off = ((found - expected) / size).abs();
                    assert!(off < 1e-12, "z {teeth}, pair {index} at {s}: {off:e}");
                }
                let off = (at(Of::Sum, x) / sum - 1.0).abs();
                assert!(off < 1e-12, "z {teeth}, sum at {s}: {off:e}");
            }
        }
    }
}
