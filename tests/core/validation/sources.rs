//! The published figures and the values that the program computes for them.

use std::f64::consts::PI;
use std::fmt::Write as _;

use tipstrike::model::compliance::{ContactPlace, Teeth};
use tipstrike::model::figures::Hertz;
use tipstrike::model::geometry::{Circles, Geometry, geometry};
use tipstrike::model::inputs::{ContactCompliance, Drive, Gear, Method, ToothCompliance};
use tipstrike::model::position::tip_at;
use tipstrike::model::static_load::StaticLoad;
use tipstrike::model::{Inputs, Solution, Stage, Stages, Station, solve};
use tipstrike::numeric::root::greatest_within;
use tipstrike::numeric::steps;

use super::{Source, figure};
use crate::stiffness::{ISO_PAIRS, at_pitch, iso_single_stiffness, pairs, stiffness, theoretical};
use crate::support::value;

const PER_MICROMETRE: f64 = 1e-6;

fn solved(inputs: &Inputs, method: Method) -> Option<Solution> {
    solve(&Inputs { method, ..inputs.clone() }, Stages::EVERY.without(Stage::Clearing)).ok()
}

fn by(inputs: &Inputs, method: Method, key: &str) -> Option<f64> {
    value(&solved(inputs, method)?, key)
}

pub(super) fn exact(inputs: &Inputs, key: &str) -> Option<f64> {
    by(inputs, Method::Exact, key)
}

/// Mean mesh stiffness at rest, in N/um.
fn mean_stiffness(inputs: &Inputs) -> Option<f64> {
    Some(PER_MICROMETRE * by(inputs, Method::Static, "mesh_stiffness")?)
}

/// Required additional tip relief at rest, in um.
fn required_relief(inputs: &Inputs) -> Option<f64> {
    let inputs = Inputs { method: Method::Static, ..inputs.clone() };
    Some(1e6 * value(&solve(&inputs, Stages::EVERY).ok()?, "clearing_relief")?)
}

/// Length of the path of contact, in mm.
fn path_length(inputs: &Inputs) -> Option<f64> {
    let geometry = geometry::<f64>(&inputs.shape()).ok()?;
    Some(1e3 * (geometry.end - geometry.start))
}

/// Reduced mass per unit width, in kg/mm.
fn mass_per_width(inputs: &Inputs) -> Option<f64> {
    Some(1e-3 * exact(inputs, "reduced_mass")? / inputs.common_width())
}

/// The linear relief of both tips, in um, with the least acceleration of the driver ahead; and its root
/// mean square in ten harmonics of the steady motion, in m/s².
fn quietest_relief(inputs: &Inputs) -> (f64, f64) {
    let acceleration = |relief: f64| {
        let mut inputs = Inputs { damping_ratio: 0.0771, ..inputs.clone() };
        (inputs.driver.tip_relief, inputs.driven.tip_relief) = (1e-6 * relief, 1e-6 * relief);
        let solution = solved(&inputs, Method::Dynamic)?;
        let frequency = 2.0 * PI * value(&solution, "mesh_frequency")?;
        let amplitudes = solution.steady?.ok()?.spectrum.amplitudes;
        let part = |(n, x): (f64, f64)| ((n * frequency).powi(2) * x).powi(2) / 2.0;
        Some((1..).map(f64::from).zip(amplitudes).map(part).sum::<f64>().sqrt())
    };
    let less = |relief: f64| -acceleration(relief).expect("a steady motion");
    let known: Vec<(f64, f64)> =
        steps(0.0, 60.0, 12).map(|relief| (relief, less(relief))).collect();
    let (relief, most) = greatest_within(&known, (1e-3, 0.0), less);
    (relief, -most)
}

/// The same pair with many stations.
fn dense(inputs: &Inputs) -> Inputs {
    Inputs { stations: Some(512), ..inputs.clone() }
}

/// Mesh stiffness F_0/x of the load at rest at each station: distance from E over the base pitch,
/// and the stiffness in N/um.
pub(super) fn mesh_stiffness(inputs: &Inputs) -> Option<Vec<(f64, f64)>> {
    let solution = solved(&dense(inputs), Method::Static)?;
    let geometry = solution.geometry;
    let of = |station: &Station| {
        (
            -station.roll_angle_driver * geometry.driver.base / geometry.base_pitch,
            PER_MICROMETRE * solution.mesh_force / station.transmission_error().expect("a load"),
        )
    };
    Some(solution.static_load?.stations.iter().map(of).collect())
}

fn stiffness_at(inputs: &Inputs, way: f64) -> Option<f64> {
    let curve = mesh_stiffness(inputs)?;
    let near = |one: &&(f64, f64)| (one.0 - way).abs();
    let best = curve.iter().min_by(|a, b| near(a).total_cmp(&near(b)))?;
    Some(best.1)
}

/// Mesh stiffness over a base pitch, in N/um.
fn stiffness_of_pitch(inputs: &Inputs) -> Option<impl Iterator<Item = f64>> {
    let curve = mesh_stiffness(inputs)?.into_iter();
    Some(curve.filter(|(way, _)| (0.0..=1.0).contains(way)).map(|(_, stiffness)| stiffness))
}

/// The least stiffness of a pair on the path, in N/um.
fn least_pair_stiffness(inputs: &Inputs) -> Option<f64> {
    let solution = solved(&dense(inputs), Method::Static)?;
    let path = solution.geometry.end - solution.geometry.start;
    let on_path = |one: &&Station| {
        (0.0..=path).contains(&(-one.roll_angle_driver * solution.geometry.driver.base))
    };
    let load = solution.static_load?;
    let compliances = load.stations.iter().filter(on_path).filter_map(|one| one.pair_compliance);
    let most = compliances.max_by(f64::total_cmp)?;
    Some(PER_MICROMETRE * inputs.common_width() / most)
}

/// The same pair whose driver is a sun with a number of planets, which share its mass.
fn sharing(inputs: &Inputs, planets: f64) -> Inputs {
    let inertia = exact(inputs, "inertia_driver").map(|inertia| inertia / planets);
    Inputs { driver: Gear { inertia, ..inputs.driver }, ..inputs.clone() }
}

/// The dynamic factor of ISO 6336-1 with a base pitch deviation of each gear, in um.
fn iso_dynamic_factor(inputs: &Inputs, driver: f64, driven: f64) -> Option<f64> {
    let mut inputs = inputs.clone();
    inputs.driver.base_pitch = Some(1e-6 * driver);
    inputs.driven.base_pitch = Some(1e-6 * driven);
    exact(&inputs, "iso_dynamic_factor")
}

/// Stiffness per unit width of the pair at the pitch point, in single-tooth contact, in N/(um mm).
fn single_stiffness(inputs: &Inputs) -> Option<f64> {
    let geometry = geometry::<f64>(&inputs.shape()).ok()?;
    let way = geometry.approach_length / geometry.base_pitch;
    Some(stiffness_at(inputs, way)? / (1e3 * inputs.common_width()))
}

/// Compliance of both teeth without contact at a place, with the twist of both bodies, in um mm/N.
fn teeth_alone(inputs: &Inputs, place: impl Fn(&Geometry) -> f64) -> Option<f64> {
    let geometry = geometry::<f64>(&inputs.shape()).ok()?;
    // r_b² (1 + ν)/(2π E) (1/r_h² − 1/r_f²)
    let twist = |gear: &Gear, circles: &Circles| {
        let body = gear.bore_radius.powi(-2) - circles.root.powi(-2);
        circles.base.powi(2) * (1.0 + gear.poisson) / (2.0 * PI * gear.young) * body
    };
    let twists = twist(&inputs.driver, &geometry.driver) + twist(&inputs.driven, &geometry.driven);
    let elasticity = inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &geometry).ok()?;
    let at = ContactPlace::on_line_of_action(&geometry, place(&geometry));
    Some(1e9 * (teeth.at(&at).ok()?.sum() + twists))
}

/// Dynamic factor of one tooth under the small load of the source, at a speed in rpm.
fn light_factor(inputs: &Inputs, speed: f64) -> Option<f64> {
    let inputs = Inputs {
        drive: Drive::Torque(381.97e-4),
        speed: speed * PI / 30.0,
        damping_ratio: 0.0771,
        ..inputs.clone()
    };
    let solution = solved(&inputs, Method::Dynamic)?;
    Some(value(&solution, "dynamic_peak_force")? / solution.mesh_force)
}

/// Dynamic factor of one tooth: its peak force over that at rest.
fn dynamic_factor(inputs: &Inputs) -> Option<f64> {
    let solution = solved(inputs, Method::Dynamic)?;
    Some(value(&solution, "dynamic_peak_force")? / value(&solution, "static_peak_force")?)
}

/// The dynamic factor at the speed at which one tooth passes in the period of the mesh.
fn resonant_factor(inputs: &Inputs) -> Option<f64> {
    let solution = solved(inputs, Method::Static)?;
    let frequency = (value(&solution, "mesh_stiffness")? / solution.reduced_mass).sqrt();
    dynamic_factor(&Inputs { speed: frequency / f64::from(inputs.driver.teeth), ..inputs.clone() })
}

/// The load at rest, with the coupling of neighbouring teeth or with independent teeth.
fn at_rest(inputs: &Inputs, is_coupled: bool) -> Option<(Geometry, StaticLoad)> {
    let inputs = Inputs { tooth_coupling: is_coupled, ..inputs.clone() };
    let solution = solved(&inputs, Method::Static)?;
    Some((solution.geometry, solution.static_load?))
}

/// Roll angle of the driver before E at the first contact, in deg.
fn first_contact(inputs: &Inputs, is_coupled: bool) -> Option<f64> {
    let (_, load) = at_rest(inputs, is_coupled)?;
    Some(load.stations.first()?.roll_angle_driver.to_degrees())
}

/// Roll angle of the driver after B at the last contact, in deg.
fn last_contact(inputs: &Inputs, is_coupled: bool) -> Option<f64> {
    let (_, load) = at_rest(inputs, is_coupled)?;
    Some(load.last_contact_angle?.to_degrees())
}

/// Mean number of loaded pairs at rest.
fn loaded_pairs(inputs: &Inputs, is_coupled: bool) -> Option<f64> {
    let (geometry, load) = at_rest(inputs, is_coupled)?;
    let before = load.first_contact_angle? * geometry.driven.base;
    let after = load.last_contact_angle? * geometry.driver.base;
    Some(geometry.contact_ratio + (before + after) / geometry.base_pitch)
}

/// Force of the incoming pair per unit width before the path begins, where the tip touches a radius
/// of the driver, in N/mm.
fn force_before_path(inputs: &Inputs, radius: f64, is_coupled: bool) -> Option<f64> {
    let (geometry, load) = at_rest(&dense(inputs), is_coupled)?;
    let before = load.stations.iter().filter(|one| one.roll_angle_driven > 0.0);
    let near =
        |one: &&Station| (tip_at(&geometry, one.roll_angle_driven).radius_driver - radius).abs();
    let best = before.min_by(|a, b| near(a).total_cmp(&near(b)))?;
    Some(1e-3 * best.force / inputs.common_width())
}

/// Mean number of pairs that touch at a place of the face, at rest.
fn pairs_over_face(inputs: &Inputs) -> Option<f64> {
    let solution = solved(inputs, Method::Static)?;
    let stations = solution.static_load?.stations;
    let angle = stations.first()?.roll_angle_driver - stations.last()?.roll_angle_driver;
    Some(angle * solution.geometry.driver.base / solution.geometry.base_pitch)
}

/// What the line loads of a tooth add up to over its passage, each with z and the path of its place:
/// ∫ ds ∫ dz over the base pitch.
fn over_passage(inputs: &Inputs, of: fn(f64, f64, &Geometry) -> f64) -> Option<f64> {
    // Enough slices for the ends of the path between two of them.
    let inputs = &Inputs { slices: Some(257), ..inputs.clone() };
    let solution = solved(inputs, Method::Static)?;
    let (load, face, geometry) = (solution.face_load?, inputs.face()?, solution.geometry);
    let rows = load.paths.iter().zip(&load.pattern);
    let row = |(path, line_loads): (&f64, &Vec<f64>)| {
        let step = face.width / (line_loads.len() - 1) as f64;
        let slice = |(number, line_load): (usize, &f64)| {
            let z = number as f64 * step - 0.5 * face.width;
            let half = if number == 0 || number + 1 == line_loads.len() { 0.5 } else { 1.0 };
            half * step * of(path + face.lead * z, *line_load, &geometry)
        };
        line_loads.iter().enumerate().map(slice).sum::<f64>()
    };
    let all: Vec<(f64, f64)> = rows.map(|at| (*at.0, row(at))).collect();
    let between = |ends: &[(f64, f64)]| 0.5 * (ends[0].1 + ends[1].1) * (ends[1].0 - ends[0].0);
    Some(all.windows(2).map(between).sum::<f64>() / geometry.base_pitch)
}

/// Greatest Hertz pressure of both flanks over the face at rest, in MPa.
fn flank_pressure(inputs: &Inputs) -> Option<f64> {
    let solution = solved(&dense(inputs), Method::Static)?;
    let stations = &solution.static_load.as_ref()?.stations;
    Some(
        PER_MICROMETRE
            * stations.iter().filter_map(|one| solution.pressure(one)).reduce(f64::max)?,
    )
}

/// Hertz pressure of the greatest line load before E between the rounded driven tip and the driver's
/// flank, in MPa.
fn edge_pressure(inputs: &Inputs) -> Option<f64> {
    let solution = solved(inputs, Method::Static)?;
    let flank = solution.geometry.start * inputs.face()?.oblique;
    let edge = inputs.driven.tip_radius?;
    let force = value(&solution, "static_entry_line_load")? * inputs.common_width();
    Some(PER_MICROMETRE * Hertz::of(inputs).pressure(force, flank * edge / (flank + edge)))
}

/// The same pair with independent slices.
pub(super) fn of_slices(inputs: &Inputs) -> Inputs {
    Inputs { slice_coupling: false, ..inputs.clone() }
}

/// Mean length of the contact lines, in mm.
fn contact_length(inputs: &Inputs) -> Option<f64> {
    let length = over_passage(inputs, |_, line_load, _| f64::from(line_load > 0.0))?;
    Some(1e3 * length * inputs.face()?.oblique)
}

/// Part of the force that the tip edges carry, in percent.
fn force_on_tips(inputs: &Inputs) -> Option<f64> {
    let all = over_passage(inputs, |_, line_load, _| line_load)?;
    let on_tips = over_passage(inputs, |path, line_load, geometry| {
        let is_on_path = (0.0..=geometry.end - geometry.start).contains(&path);
        if is_on_path { 0.0 } else { line_load }
    })?;
    Some(100.0 * on_tips / all)
}

/// Per unit width, in N/mm.
fn per_width(inputs: &Inputs, key: &str) -> Option<f64> {
    Some(1e-3 * exact(inputs, key)? / inputs.common_width())
}

/// A stiffness per width, in N/(um mm).
fn per_um(inputs: &Inputs, method: Method, key: &str) -> Option<f64> {
    Some(1e-9 * by(inputs, method, key)?)
}

const GEOMETRY: &str = "yes. It is geometry alone.";
const FORMULAS: &str = "yes. The same formulas.";
const FORCE: &str = "yes. It is torque over radius.";
const WEB: &str = "yes, but for the gear blank: the report has the factor C_R of a web of a quarter of the face \
    width with a rim of 3.5 modules, 0.8623, and of 5 modules, 0.8980. tipstrike has solid gears, C_R = 1; times \
    these factors its figures are those of the report.";
const MODEL: &str = "partly. The report's c_gamma contains C_R and the factor 0.8 between theory and \
    measurement; the models here have neither.";
const RINGS: &str = "partly. The report takes rings to the mean diameter; tipstrike integrates the outline, and the \
    bore is the inside of the rim. Three planets share the mass of a sun, so here a sun has a third of its inertia.";
const SPEED: &str = "partly. The report has c_gamma, with C_R and the factor 0.8, where tipstrike has its mean \
    stiffness. Together with the reduced mass, each by its square root, this is the whole deviation. The speed of a \
    sun is that relative to the carrier. In stages 1 and 2 the report prints two digits of N.";
const FACTOR: &str = "partly. The formulas are the same. The report has an application factor of 1.25, with planets \
    also a distribution factor of 1.10, running-in allowances of 1.2 to 2.5 um, profile form deviations of 22 to 33 um, \
    and C_R. tipstrike has none of these and takes the base pitch deviation for the form deviation.";

const SUM_OF_ENERGY: &str = "partly. The source uses the potential-energy method as well, with \
    another fillet, another foundation and its own contact stiffness, which does not depend on load.";
const LIGHT: &str = "partly. The pair, its damping and the load are the same. The source computes \
    stiffness, inertia and load share with its own models, and without contact outside the line of \
    action. Near a resonance a small difference in stiffness changes the factor strongly.";

#[rustfmt::skip]
macro_rules! light {
    ($speed:literal, $published:literal, $fair:expr) => {
        figure(concat!("dynamic factor of one tooth at ", $speed, " rpm"), "", $published,
            |inputs| light_factor(inputs, f64::from($speed)), $fair)
    };
}

/// A stage of a gearbox whose sun meshes with a number of planets: figures of its own, then w, c', c_gamma,
/// reduced mass, N and n_E1, and K_V with its base pitch deviations.
#[rustfmt::skip]
macro_rules! nrel {
    ($stage:literal, $from:literal, $case:literal, $planets:literal, [$($own:expr),*],
        [$w:literal, $single:literal, $mesh:literal, $mass:literal, $ratio:literal, $speed:literal],
        $factor:literal with $driver:literal and $driven:literal) => {
        Source { title: concat!("KISSsoft, ", $stage, " of NREL 5 MW"), from: $from, case: $case, figures: &[
            $($own,)*
            figure("tangential force per width", "N/mm", $w, |inputs| per_width(inputs, "tangential_force"), FORCE).by_no_model(),
            figure("c'", "N/(um mm)", $single, |inputs| per_um(inputs, Method::Exact, "iso_single_stiffness"), WEB).by_no_model(),
            figure("c_gamma_alpha", "N/(um mm)", $mesh, |inputs| per_um(inputs, Method::Exact, "iso_mesh_stiffness"), "").by_no_model(),
            figure("c_gamma_alpha, by the models", "N/(um mm)", $mesh,
                |inputs| per_um(inputs, Method::Static, "mesh_stiffness_per_width"), MODEL),
            figure("reduced mass per width", "kg/mm", $mass, |inputs| mass_per_width(&sharing(inputs, $planets)), RINGS).by_no_model(),
            figure("resonance ratio N", "", $ratio, |inputs| by(&sharing(inputs, $planets), Method::Static, "resonance_ratio"), SPEED),
            figure("resonance speed n_E1", "rpm", $speed,
                |inputs| Some(by(&sharing(inputs, $planets), Method::Static, "resonance_speed")? * 30.0 / PI), SPEED),
            figure(concat!("dynamic factor K_V, with its base pitch deviations of ", $driver, " and ", $driven, " um"), "", $factor,
                |inputs| iso_dynamic_factor(&sharing(inputs, $planets), $driver, $driven), FACTOR).by_no_model(),
        ] }
    };
}

#[rustfmt::skip]
pub(super) const SOURCES: &[Source] = &[
    Source { title: "ROSS", case: "ross-62-62",
        from: "petrobras/ross, its gear tests, the same in version 2.3.0; potential energy, constant contact", figures: &[
        figure("contact ratio", "", 1.789_779_866_8, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model(),
        figure("mesh stiffness at the start of double contact", "N/um", 396.62, |inputs| stiffness_at(inputs, 0.0), SUM_OF_ENERGY),
        figure("greatest mesh stiffness", "N/um", 419.57, |inputs| stiffness_of_pitch(inputs)?.reduce(f64::max), SUM_OF_ENERGY),
        figure("mean of its curve over a base pitch, 2.3.0", "N/um", 373.51, mean_stiffness, "partly, for the same reasons."),
        figure("its one value of the mesh stiffness, 2.3.0", "N/um", 409.66, mean_stiffness,
            "no. Version 2.3.0 computes it as ε_α b E_1 E_2/(9 (E_1 + E_2)), without the shape of the teeth; until \
            then it was the greatest of the curve. It is 9.7 % above the mean of its own curve."),
        figure("polar inertia of a gear", "kg m2", 0.003_602_5, |inputs| exact(inputs, "inertia_driver"),
            "partly. The source takes a disc to the reference circle; tipstrike integrates the outline.").by_no_model(),
    ] },
    Source { title: "ROSS, pair with backlash", case: "ross-20-20",
        from: "petrobras/ross at 631a249a, its test of a mesh with backlash, means over a motion", figures: &[
        figure("contact ratio", "", 1.552_51, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model(),
        figure("mesh force", "N", 3191.996, |inputs| exact(inputs, "mesh_force"), FORCE).by_no_model(),
        figure("mesh stiffness", "N/um", 517.925, mean_stiffness,
            "no. It is a square wave about ε_α b E_1 E_2/(9 (E_1 + E_2)), without the shape of the teeth. The mean transmission \
            error of 71.53 um is not compared: it contains 64.98 um of backlash with a chosen error."),
    ] },
    Source { title: "Dias et al. 2024", case: "dias-27-35",
        from: "code TPM-Vibration (flaviohasd/TPM-Vibration), figures of its Python version and of a port", figures: &[
        figure("mean mesh stiffness", "N/um", 353.2, mean_stiffness, "partly. The source uses the potential-energy method."),
        figure("equivalent mass", "kg", 0.3493, |inputs| exact(inputs, "reduced_mass"),
            "partly. The source has a ring to the root circle, and the mass of each tooth at its centre of \
            gravity; tipstrike integrates the outline.").by_no_model(),
        figure("greatest deflection of the mesh at rest", "um", 43.881,
            |inputs| Some(exact(inputs, "mesh_force")? / stiffness_of_pitch(inputs)?.reduce(f64::min)?),
            "partly. The source divides the mesh force by its least stiffness. Its teeth are softer by the \
            potential-energy method on base-circle cantilevers."),
        figure("least RMS acceleration, over equal tip reliefs of both gears", "m/s2", 90.807, |inputs| Some(quietest_relief(inputs).1),
            "partly. Pair, load, damping and the shape of the relief are the same, and both figures are the least over the amount. \
            The source keeps every pair in contact over the whole path. tipstrike has ten harmonics, with \
            `finite-element` 99 % of the whole."),
        figure("relief of this least acceleration", "um", 43.519, |inputs| Some(quietest_relief(inputs).0),
            "partly. The teeth of the source are softer. With its stiffness model the formula of tipstrike for no contact before E \
            gives 43.23 um (-0.7 %). The MATLAB version of the source gives 43.58 um."),
        light!(500, 1.327, LIGHT), light!(1000, 1.322, ""), light!(2000, 1.263, ""), light!(3000, 1.368, ""),
        light!(4000, 1.202, ""), light!(5000, 1.519, ""), light!(7000, 1.078, ""),
    ] },
    Source { title: "Chen & Shao 2011", case: "chen-shao-30-25",
        from: "Chen & Shao 2011, potential energy, as quoted by later papers", figures: &[
        figure("least stiffness of a pair", "N/um", 152.0, least_pair_stiffness,
            "partly. The figure is second-hand, and bores and fillets of the source are not known to us. The source \
            uses the potential-energy method."),
    ] },
    Source { title: "GEARpie, FZG C14", case: "fzg-c14",
        from: "GEARpie's report on FZG C14; DIN 3990", figures: &[
        figure("contact ratio", "", 1.46, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model(),
        figure("path of contact", "mm", 19.43, path_length, GEOMETRY).by_no_model(),
        figure("force along the line of action", "N", 5912.1, |inputs| exact(inputs, "mesh_force"), "yes. It is torque over base radius.").by_no_model(),
        figure("reduced mass per width", "kg/mm", 0.012_86, mass_per_width,
            "partly. DIN 3990 takes a disc to the mean diameter; tipstrike integrates the outline. The bores are assumed.").by_no_model(),
        figure("dynamic factor K_V at 1500 rpm", "", 1.02, dynamic_factor,
            "no. K_V applies to the whole mesh, follows an empirical rule and includes pitch deviations. The \
            factor of tipstrike is the peak force of one tooth in motion divided by its peak force at rest, \
            without deviations."),
        figure("dynamic factor K_V in resonance", "", 2.01, resonant_factor, "no, for the same reason."),
    ] },
    Source { title: "ISO/TR 6336-30, example 1", case: "iso-6336-30-1",
        from: "ISO/TR 6336-30, example 1, taken as a spur pair", figures: &[
        figure("c'/cos β", "N/(um mm)", 12.86, single_stiffness,
            "partly. The example is helical, and c' is a fit to measured stiffness without the twist of the \
            body. `beam` and `finite-element` also exclude the twist."),
    ] },
    Source { title: "ISO/TR 6336-30, example 1, as a helical pair", case: "iso-6336-30-1-helical",
        from: "ISO/TR 6336-30, example 1", figures: &[
        figure("virtual teeth of the driver", "", 18.905, |inputs| exact(inputs, "virtual_teeth_driver"), GEOMETRY).by_no_model(),
        figure("virtual teeth of the driven gear", "", 114.543, |inputs| exact(inputs, "virtual_teeth_driven"), "").by_no_model(),
        figure("tangential force", "N", 127_352.0, |inputs| exact(inputs, "tangential_force"), FORCE).by_no_model(),
        figure("c'_th", "N/(um mm)", 17.855_84, |inputs| Some(theoretical(inputs)), FORMULAS).by_no_model(),
        figure("c'", "N/(um mm)", 12.370_47, |inputs| per_um(inputs, Method::Exact, "iso_single_stiffness"), FORMULAS).by_no_model(),
        figure("c_gamma_alpha", "N/(um mm)", 17.464_85, |inputs| per_um(inputs, Method::Exact, "iso_mesh_stiffness"), FORMULAS).by_no_model(),
        figure("c_gamma_alpha, by the models", "N/(um mm)", 17.464_85,
            |inputs| per_um(inputs, Method::Static, "mesh_stiffness_per_width"),
            "partly. c_gamma contains the factor 0.8 between theory and measurement; the models do not."),
        figure("face load factor K_Hβ, with a misalignment of 27.5 um", "", 1.16,
            |inputs| by(&Inputs { misalignment: 27.5e-6, ..inputs.clone() }, Method::Static, "face_load_factor"),
            "partly. The misalignment of the example is not known to us; 27.5 um gives 1.16 by method C with its \
            c_γβ of 14.845 N/(um mm), a constant stiffness. The models have slices."),
    ] },
    nrel!("stage 1", "report of KISSsoft 03/2017A in gfsReboucas/Drivetrain, sun and planet", "kisssoft-nrel-1", 3.0,
        [figure("contact ratio", "", 1.115, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model()],
        [1587.48, 12.362, 13.426, 0.6606, 0.016, 2266.0], 1.01 with 31.0 and 31.0),
    nrel!("stage 2", "the same report, sun and planet of stage 2", "kisssoft-nrel-2", 3.0,
        [figure("contact ratio", "", 1.370, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model()],
        [519.82, 12.240, 15.640, 0.1534, 0.046, 5357.0], 1.02 with 16.9 and 17.9),
    nrel!("helical stage 3", "the same report, helical stage", "kisssoft-nrel-3", 1.0,
        [figure("transverse contact ratio", "", 1.463, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model(),
        figure("overlap ratio", "", 1.421, |inputs| exact(inputs, "overlap_ratio"), GEOMETRY).by_no_model(),
        figure("optimum tip relief C_eff, of 1.25 times the load", "um", 44.74,
            |inputs| required_relief(&Inputs { drive: Drive::Torque(1.25 * inputs.torque()), ..inputs.clone() }),
            "no. C_eff is 1.25 w/c_gamma, the mean deflection of the mesh. tipstrike's figure is the relief of the \
            driven tip without contact before E.")],
        [666.85, 13.832, 18.632, 0.365_03, 0.410, 2843.0], 1.092 with 13.1 and 15.9),
    Source { title: "GEARpie, gear H501", case: "gearpie-h501",
        from: "GEARpie, helical gear H501", figures: &[
        figure("transverse contact ratio", "", 1.46, |inputs| exact(inputs, "contact_ratio"), GEOMETRY).by_no_model(),
        figure("overlap ratio", "", 0.54, |inputs| exact(inputs, "overlap_ratio"), GEOMETRY).by_no_model(),
        figure("transverse base pitch", "mm", 10.652, |inputs| Some(1e3 * exact(inputs, "base_pitch")?), GEOMETRY).by_no_model(),
        figure("path of contact", "mm", 15.55, path_length, GEOMETRY).by_no_model(),
        figure("force along the line of action", "N", 2949.2, |inputs| exact(inputs, "mesh_force"), FORCE).by_no_model(),
        figure("axial force", "N", 739.5, |inputs| exact(inputs, "axial_force"), FORCE).by_no_model(),
    ] },
    Source { title: "Helical contact outside the path of contact", case: "gearcalc-17-43-helical",
        from: "git-akai/gearcalc, record `phase/h20` of its field oracle", figures: &[
        figure("mean number of pairs in contact", "", 2.587_17, pairs_over_face,
            "partly. The pair, the load, the friction and the rounded tips are the same. The source has \
            independent slices whose tooth is computed by its potential energy.")
            .without("independent slices", |inputs| pairs_over_face(&of_slices(inputs))),
        figure("mean length of the contact lines", "mm", 15.4507, contact_length,
            "partly, for the same reasons. Here the slices that touch are counted.")
            .without("independent slices", |inputs| contact_length(&of_slices(inputs))),
        figure("part of the force on tip edges", "%", 1.787, force_on_tips,
            "partly, for the same reasons, and because the part beyond the ends of the path differs with the \
            stiffness of the pair.")
            .without("independent slices", |inputs| force_on_tips(&of_slices(inputs))),
        figure("total contact ratio with sharp tips", "", 2.580_562, |inputs| {
            let mut sharp = inputs.clone();
            (sharp.driver.tip_radius, sharp.driven.tip_radius) = (None, None);
            exact(&sharp, "total_contact_ratio")
        }, GEOMETRY).by_no_model(),
        figure("greatest pressure, at the wheel's tip edge", "MPa", 1992.94, edge_pressure,
            "partly. Pair, load and edge radius are the same. The contact line ends at this edge, and in coupled slices the \
            unloaded tooth beyond takes part: the line load is 2.6 times that of independent slices. The source has the \
            contact of flank and edge together; here the greatest line load before E is on the edge alone.")
            .without("independent slices", |inputs| edge_pressure(&of_slices(inputs))),
        figure("greatest pressure of the flanks", "MPa", 1606.50, flank_pressure,
            "no. On the flank alone this pressure needs 65 N/mm at E, so in the source a part of this contact is on the edge. \
            tipstrike has Hertz's pressure of two flanks.")
            .without("independent slices", |inputs| flank_pressure(&of_slices(inputs))),
    ] },
    Source { title: "Plane-strain finite elements", case: "gearcalc-17-43",
        from: "git-akai/gearcalc, notes", figures: &[
        figure("both teeth without contact at the pitch point, with the twist of the bodies", "um mm/N", 0.043_11,
            |inputs| teeth_alone(inputs, |geometry| geometry.start + geometry.approach_length),
            "yes. The same pair, bores and elasticity, by finite elements in plane strain. The source includes \
            the twist of the bodies, which the models here exclude; the table adds it by its closed form."),
        figure("both teeth without contact at the wheel's tip, with the twist of the bodies", "um mm/N", 0.070_37,
            |inputs| teeth_alone(inputs, |geometry| geometry.start),
            "partly, with the same remark. The place of the load patch at the tip corner is not known to us."),
        figure("c' at the pitch point", "N/(um mm)", 17.06, single_stiffness,
            "partly. The load of the source is not known to us, and the contact depends on it."),
    ] },
    Source { title: "Contact outside the line of action", case: "gearcalc-17-43-rounded",
        from: "git-akai/gearcalc, two-dimensional contact model: the spur pair of its field oracle, records `phase/s0` and `state/s0/0.75`", figures: &[
        figure("pair stiffness at the pitch point", "N/(um mm)", 15.821,
            |inputs| single_stiffness(&Inputs { friction_coefficient: None, ..inputs.clone() }),
            "partly. The pair and the load of 250.4 N/mm are the same. The source computes the tooth by its \
            potential energy with the foundation of a half-plane, not by finite elements."),
        figure("first contact before the path begins, pinion", "deg", 2.155, |inputs| first_contact(inputs, true),
            "partly. The pair, the load, the friction and the rounded tips are the same, but in the source no \
            tooth displaces its neighbours. The row with independent teeth shows how much of the deviation of \
            `finite-element` this explains. The rest agrees in sign with the softer pair of the source; \
            whether it has other reasons is not known. `beam` has independent teeth and nearly the pair \
            stiffness of the source. `kuang-yang` is softer, so its contact begins too early.")
            .without("independent teeth", |inputs| first_contact(inputs, false)),
        figure("last contact after the path ends, pinion", "deg", 3.229, |inputs| last_contact(inputs, true),
            "partly, for the same reasons.").without("independent teeth", |inputs| last_contact(inputs, false)),
        figure("mean number of loaded pairs", "", 1.8032, |inputs| loaded_pairs(inputs, true),
            "partly, for the same reasons.").without("independent teeth", |inputs| loaded_pairs(inputs, false)),
        figure("force of the entering pair where the wheel's tip touches the pinion radius 8.0282 mm", "N/mm", 91.46,
            |inputs| force_before_path(inputs, 8.0282e-3, true),
            "partly, for the same reasons. The source gives the force in the middle of the face, tipstrike the \
            mean over the face width. The contact is on the rounded tip before the path begins.")
            .without("independent teeth", |inputs| force_before_path(inputs, 8.0282e-3, false)),
    ] },
];

/// The stiffness of pairs compared with ISO 6336-1.
pub(super) fn iso_table() -> String {
    let names = ToothCompliance::ALL.map(ToothCompliance::name);
    let mut text = format!(
        "\n## ISO 6336-1, method B\n\nSource: ISO 6336-1, c' at 300 N/mm, in N/(um mm). Inputs: the case \
         files of the table, in `tests/validation/`. Each gear is bored to a third of its root radius; the \
         columns give the single pair at the pitch point with the logarithmic contact compliance.\n\n\
         | pair | case file | ISO 6336-1 c' | {} |\n|---|---|---|{}\n",
        names.join(" | "),
        "---|".repeat(names.len())
    );
    for (inputs, file) in pairs().iter().zip(ISO_PAIRS) {
        let iso = iso_single_stiffness(inputs);
        let cells = ToothCompliance::ALL.map(|model| {
            let ours = stiffness(inputs, model, ContactCompliance::LOGARITHMIC, at_pitch);
            format!("{ours:.2} ({:+.0} %)", 100.0 * (ours / iso - 1.0))
        });
        let (driver, driven) = (&inputs.driver, &inputs.driven);
        writeln!(
            text,
            "| z {}/{}, x {}/{} | `{file}.toml` | {iso:.2} | {} |",
            driver.teeth,
            driven.teeth,
            driver.profile_shift,
            driven.profile_shift,
            cells.join(" | ")
        )
        .unwrap();
    }
    text + "\nIs it fair? Partly: c' is a fit to measured stiffness with the factor 0.8 for the \
        difference between theory and measurement, and does not include the twist of the body.\n"
}
