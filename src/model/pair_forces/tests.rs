//! Tests random pairs against the conditions of the complementarity problem.

use super::complementarity::Until;
use super::*;

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

fn pair(ahead: i32, stiffness: f64, gap: f64) -> Pair {
    Pair { ahead, stiffness, gap, weight: 1.0 }
}

/// Up to six random pairs with strong coupling over three pitches. The gaps are as large as the
/// deflections.
fn random_pairs(state: &mut u64) -> PairSet {
    loop {
        let count = 1 + (random(state) * 6.0) as i32;
        let pairs = (0..count).map(|ahead| {
            let stiffness = 0.5 + 2.0 * random(state);
            pair(ahead - 1, stiffness, 2.0 * random(state) - 0.5)
        });
        let pairs: Vec<Pair> = pairs.collect();
        let couplings = (0..count).map(|_| {
            [0.7, 0.4, 0.3].map(|most| most * random(state)).map(|coupling| coupling - 0.05)
        });
        let set = PairSet::new(pairs, couplings);
        if set.is_definite() {
            return set;
        }
    }
}

/// Violation of the conditions of the complementarity problem, which has one solution.
fn violation(set: &PairSet, displacement: f64, forces: &[f64]) -> f64 {
    let rest = |(index, pair): (usize, &Pair)| {
        let own = forces[index] / pair.stiffness;
        let overlap = displacement - pair.gap - own - set.pushed(index, forces);
        let wrong = if forces[index] > 0.0 { overlap.abs() } else { overlap };
        wrong.max(-forces[index])
    };
    set.pairs().iter().enumerate().map(rest).fold(0.0, f64::max)
}

#[test]
fn each_pair_has_either_a_force_or_a_gap() {
    let mut state = 7;
    for round in 0..20_000 {
        let set = random_pairs(&mut state);
        let total = 3.0 * random(&mut state) + 1e-6;
        let (displacement, forces) = set.shared(total);
        let sum: f64 = forces.iter().sum();
        assert!((sum / total - 1.0).abs() < 1e-9, "{round}: {sum} of {total}");
        let off = violation(&set, displacement, &forces);
        assert!(off < 1e-9, "{round}: error {off:e}, {set:?}");
        for (force, expected) in set.forces(displacement).iter().zip(&forces) {
            assert!((force - expected).abs() < 1e-8, "{round}: {force} {expected}");
        }
    }
}

#[test]
fn the_lead_of_a_loaded_pair_is_positive() {
    let mut state = 5;
    for _ in 0..5_000 {
        let set = random_pairs(&mut state);
        let total = random(&mut state) + 1e-3;
        let lead = set.clone().lead(0, total);
        let force = set.balance(total).force;
        let is_close = lead.abs() < 1e-9;
        assert!(is_close || (lead > 0.0) == (force > 0.0), "{lead} {force} {set:?}");
    }
}

#[test]
fn pairs_without_coupling_are_independent_springs() {
    let mut state = 3;
    for _ in 0..2_000 {
        let set = random_pairs(&mut state);
        let total = 2.0 * random(&mut state) + 1e-6;
        let count = set.pairs().len();
        let springs = PairSet::new(set.pairs().to_vec(), []);
        let uncoupled = PairSet::new(set.pairs().to_vec(), vec![[0.0; PITCHES]; count]);
        let ((x, forces), (expected, springs)) = (uncoupled.shared(total), springs.shared(total));
        assert!((x - expected).abs() < 1e-12, "{x} {expected}");
        for (force, expected) in forces.iter().zip(springs) {
            assert!((force - expected).abs() < 1e-12, "{force} {expected}");
        }
    }
}

#[test]
fn equal_pairs_share_the_load_equally() {
    let pairs = (0..3).map(|ahead| pair(ahead, 0.5, 0.1));
    let (x, forces) = PairSet::new(pairs, vec![[0.5; PITCHES]; 3]).shared(3.0);
    for force in forces {
        assert!((force - 1.0).abs() < 1e-14, "{force}");
    }
    assert!((x - 3.1).abs() < 1e-14, "{x}");
}

#[test]
fn leads_of_touching_pairs_are_their_forces() {
    let mut state = 11;
    for _ in 0..2_000 {
        let set = random_pairs(&mut state);
        let (x, forces) = set.shared(1.0);
        let carries = forces.iter().enumerate().filter(|(_, force)| **force > 0.0);
        let touching = carries.fold(Touching::NONE, |set, (index, _)| set.with(index));
        let leads = set.leads(touching, x);
        for (index, lead) in leads.iter().enumerate() {
            if touching.has(index) {
                let force = lead * set.pairs()[index].stiffness;
                assert!((force - forces[index]).abs() < 1e-9);
            } else {
                assert!(*lead < 1e-9, "{lead}");
            }
        }
    }
}

#[test]
fn a_guess_of_the_touching_pairs_finds_the_forces_that_the_growing_displacement_finds() {
    let (mut state, mut guessed) = (13, 0);
    for round in 0..5_000 {
        let set = random_pairs(&mut state);
        let own = set.own();
        for until in
            [Until::Total(random(&mut state) + 1e-3), Until::Displacement(2.0 * random(&mut state))]
        {
            let (expected_x, expected) = set.followed(&own, until);
            if let Some((x, forces)) = set.guessed(&own, until) {
                guessed += 1;
                assert!((x - expected_x).abs() < 1e-9, "{round}: {x} {expected_x}");
                for (force, expected) in forces.iter().zip(&expected) {
                    let off = (force - expected).abs();
                    assert!(off < 1e-8, "{round}: {force} {expected}");
                }
            }
        }
    }
    assert!(guessed > 9_000, "{guessed} of 10000 guesses");
}
