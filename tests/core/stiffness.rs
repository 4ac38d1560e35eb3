//! Pair stiffness compared with published values: ISO 6336-1 method B, and results of open codes.
use crate::support::{inputs, standard_pair};
use tipstrike::case::fields::key_of;
use tipstrike::model::compliance::tooth::beam;
use tipstrike::model::compliance::{ContactPlace, Teeth};
use tipstrike::model::figures::{rack_factor, single_stiffness, theoretical_stiffness};
use tipstrike::model::geometry::{Geometry, geometry};
use tipstrike::model::inputs::{ContactCompliance, Gear, Method, ToothCompliance};
use tipstrike::model::{Inputs, Refusal, Stages, solve};

/// Load of ISO 6336-1's linear range, in N/m.
const LINE_LOAD: f64 = 300e3;

/// Theoretical single stiffness c'_th of ISO 6336-1, in N/(µm mm).
pub(crate) fn theoretical(inputs: &Inputs) -> f64 {
    let gears = [&inputs.driver, &inputs.driven];
    let virtual_teeth = gears.map(|gear| inputs.virtual_teeth(gear));
    1e-9 * theoretical_stiffness(virtual_teeth, gears.map(|gear| gear.profile_shift))
}

/// Single stiffness c' of ISO 6336-1 method B for a solid disc and the standard rack, in N/(µm mm).
pub(crate) fn iso_single_stiffness(inputs: &Inputs) -> f64 {
    single_stiffness(theoretical(inputs), rack_factor([1.25; 2], inputs.pressure_angle), 1.0)
}

/// A pair with bores of a third of the root radius, as for a disc on its shaft.
fn pair((z1, x1): (u32, f64), (z2, x2): (u32, f64)) -> Inputs {
    let mut inputs = standard_pair(z1, z2, 5e-3);
    (inputs.driver.profile_shift, inputs.driven.profile_shift) = (x1, x2);
    let module = inputs.module;
    let bore =
        |gear: &Gear| module * (f64::from(gear.teeth) / 2.0 - 1.25 + gear.profile_shift) / 3.0;
    inputs.driver.bore_radius = bore(&inputs.driver);
    inputs.driven.bore_radius = bore(&inputs.driven);
    inputs
}

/// The case files of the comparison with ISO 6336-1: FZG type C, equal, unequal and profile-shifted
/// pairs. Their torque is the load of [`LINE_LOAD`].
pub(crate) const ISO_PAIRS: [&str; 7] = [
    "iso-6336-1-16-24",
    "iso-6336-1-20-20",
    "iso-6336-1-28-28",
    "iso-6336-1-20-60",
    "iso-6336-1-40-40",
    "iso-6336-1-25-100",
    "iso-6336-1-60-90",
];

/// The pairs of [`ISO_PAIRS`].
pub(crate) fn pairs() -> [Inputs; 7] {
    ISO_PAIRS.map(|name| inputs(&format!("tests/validation/{name}.toml")))
}

#[test]
fn the_case_files_of_the_iso_table_have_its_load_and_its_bores() {
    for given in pairs() {
        let [driver, driven] = [&given.driver, &given.driven];
        let wanted =
            pair((driver.teeth, driver.profile_shift), (driven.teeth, driven.profile_shift));
        for (gear, wanted) in [(driver, &wanted.driver), (driven, &wanted.driven)] {
            assert!((gear.bore_radius - wanted.bore_radius).abs() < 1e-9);
        }
        let solution = solve(&given, Stages::CLOSED_FORM).expect("a solution");
        let load = solution.mesh_force / given.common_width();
        assert!((load / LINE_LOAD - 1.0).abs() < 1e-5, "{load}");
    }
}

/// Stiffness of the pair at a place, in N/(µm mm).
pub(crate) fn stiffness(
    inputs: &Inputs,
    model: ToothCompliance,
    contact: ContactCompliance,
    along: impl Fn(&Geometry) -> f64,
) -> f64 {
    let inputs =
        Inputs { tooth_compliance: Some(model), contact_compliance: contact, ..inputs.clone() };
    let geometry = geometry(&inputs.shape()).expect("a meshing pair");
    let place = ContactPlace::on_line_of_action(&geometry, along(&geometry));
    let elasticity = inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &geometry).expect("teeth");
    let compliance = teeth.pair_at_load(&place, LINE_LOAD * inputs.common_width());
    1e-9 / compliance.expect("a compliance")
}

pub(crate) fn at_pitch(geometry: &Geometry) -> f64 {
    geometry.start + geometry.approach_length
}

fn at_end(geometry: &Geometry) -> f64 {
    geometry.start
}

/// ISO 6336-1 uses 0.8 of the theoretical value c'th for c', because measured gears are softer.
#[test]
fn single_stiffness_is_within_a_quarter_of_the_range_from_iso_c_to_its_theoretical_value() {
    const MEASURED_PART: f64 = 0.8;
    for inputs in pairs() {
        let iso = iso_single_stiffness(&inputs);
        let range = 0.75 * iso..1.25 * iso / MEASURED_PART;
        for model in ToothCompliance::ALL {
            let ours = stiffness(&inputs, model, ContactCompliance::LOGARITHMIC, at_pitch);
            let name = model.name();
            assert!(range.contains(&ours), "{name}: {ours} and {iso} of {:?}", inputs.driver);
        }
    }
}

#[test]
fn iso_value_of_the_standard_pair() {
    let iso = iso_single_stiffness(&pair((20, 0.0), (20, 0.0)));
    assert!((iso - 11.487).abs() < 5e-4, "{iso}");
}

/// z 20/20, m 5 mm, with the constant contact term, at the end of the path and at the pitch point.
#[test]
fn kuang_yang_has_the_published_stiffness_of_an_equal_pair() {
    let inputs = pair((20, 0.0), (20, 0.0));
    let constant = |model, place: fn(&Geometry) -> f64| {
        stiffness(&inputs, model, ContactCompliance::CONSTANT, place)
    };
    for (place, published) in [(at_end as fn(&Geometry) -> f64, 8.30), (at_pitch, 11.97)] {
        let fit = constant(ToothCompliance::KUANG_YANG, place);
        assert!((fit - published).abs() < 0.02, "kuang-yang {fit}, published {published}");
    }
}

#[test]
fn a_tooth_is_stiffer_the_nearer_the_load_is_to_its_root() {
    for inputs in pairs() {
        let geometry = geometry::<f64>(&inputs.shape()).expect("a meshing pair");
        let (tip, base) = (geometry.driver.tip, geometry.driver.base);
        let loads = [1.0, 0.8, 0.6, 0.4, 0.2]
            .map(|part| geometry.driver.base.max(geometry.driver.root) + part * (tip - base) * 0.9);
        let found = loads
            .map(|radius| beam::tooth(&inputs.elasticity().driver, &geometry.driver, radius).ok());
        let given: Vec<f64> = found.into_iter().flatten().collect();
        assert!(given.len() >= 3 && given.is_sorted_by(|a, b| a > b), "{}", inputs.driver.teeth);
    }
}

#[test]
fn young_poisson_and_bore_enter() {
    let plain = pair((30, 0.0), (30, 0.0));
    let beam = |change: &dyn Fn(&mut Inputs)| {
        let mut inputs = plain.clone();
        change(&mut inputs);
        let geometry = geometry::<f64>(&inputs.shape()).expect("a meshing pair");
        beam::tooth(&inputs.elasticity().driver, &geometry.driver, geometry.driver.tip)
            .expect("a compliance")
    };
    let before = beam(&|_| ());
    // Compliance is proportional to 1/E, and plane strain is stiffer than plane stress.
    assert!((beam(&|inputs| inputs.driver.young /= 2.0) / before - 2.0).abs() < 1e-12);
    assert!(beam(&|inputs| inputs.driver.poisson = 0.0) > 1.02 * before);
    // With the twist of the body, half of the bore would double the compliance.
    for part in [0.6, 0.4] {
        let ratio = beam(&|inputs| inputs.driver.bore_radius *= part) / before;
        assert!((0.85..1.15).contains(&ratio), "bore times {part}: {ratio}");
    }
}

#[test]
fn a_contact_below_the_form_circle_is_refused_at_the_addendum_that_reaches_there() {
    for (teeth, key) in [((40, 30), "driver.addendum"), ((30, 40), "driven.addendum")] {
        let mut inputs = standard_pair(teeth.0, teeth.1, 2e-3);
        inputs.method = Method::Static;
        inputs.base_pitch_deviation = 10e-6;
        for gear in [&mut inputs.driver, &mut inputs.driven] {
            gear.bore_radius = 15e-3;
            gear.addendum = if gear.teeth == 40 { 1.3 } else { 1.0 };
        }
        let refusal = solve(&inputs, Stages::EVERY).unwrap_err();
        assert_eq!((refusal.code(), key_of(refusal.at())), ("below-form-circle", key));
    }
}

#[test]
fn a_pair_ahead_inside_the_base_circle_is_no_lack_of_contact_ratio() {
    let mut inputs = standard_pair(11, 6, 8.46e-3);
    inputs.pressure_angle = 25f64.to_radians();
    inputs.driver.profile_shift = -0.217;
    inputs.driver.dedendum = 1.64;
    inputs.driven.profile_shift = 0.145;
    inputs.driven.dedendum = 1.37;
    inputs.driven.addendum = 0.9;
    inputs.driven.tip_radius = Some(3.42e-3);
    (inputs.driver.bore_radius, inputs.driven.bore_radius) = (7e-3, 15e-3);
    let refusal = solve(&inputs, Stages::EVERY).unwrap_err();
    assert!(matches!(refusal, Refusal::InterferenceAtEnd { start } if start < 0.0), "{refusal:?}");
}
