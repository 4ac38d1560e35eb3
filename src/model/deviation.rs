//! The deviation that makes the tooth early: equivalent error and combined deflection. The base pitch
//! deviation of a gear is given by the case or comes from its flank tolerance class.

use std::f64::consts::SQRT_2;
use std::ops::RangeInclusive;

use smallvec::SmallVec;
use twofloat::TwoFloat;

use super::Refusal;
use super::compliance::{ContactPlace, Teeth};
use super::face::FaceInputs;
use super::geometry::Geometry;
use super::inputs::{Combination, Gear, Inputs, Method};
use crate::numeric::{Real, distinct, quadrature};

/// Deviation along the line of action, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation<T = f64> {
    /// Equivalent error Δf, Eqs. 1 and 2. `static` and `dynamic` exclude the reliefs, which act on
    /// the flanks.
    pub equivalent_error: T,
    /// Modification e_m at the run-in contact, Eq. 1; negative if material is removed.
    pub modification: T,
    /// Combined deflection δ: the deflection of the pairs that carry the load, Eqs. 3 and 4, minus
    /// the displacement of the incoming pair by their forces.
    pub combined_deflection: T,
    /// Displacement of the incoming pair by the forces on the pairs ahead. 0 in the method `paper`
    /// and for tooth models without coupling.
    pub neighbour_deflection: T,
    /// Δ = Δf + δ, Eq. 5, with reliefs in every method; in the method `exact` with the earliness over
    /// the face. A tooth strikes only if Δ > 0.
    pub total: T,
}

/// The deviation in double-double arithmetic, because a relief can cancel all but a small part.
/// `by_load` computes the deflection if the case does not give it.
///
/// # Errors
/// Those of `by_load`.
pub(super) fn deviation(
    inputs: &Inputs,
    by_load: impl FnOnce() -> Result<Deflected, Refusal>,
) -> Result<Deviation<TwoFloat>, Refusal> {
    let deflected = match inputs.given_deflection() {
        Some(pairs_ahead) => Deflected { pairs_ahead, incoming_pair: 0.0 },
        None => by_load()?,
    };
    let combined_deflection = TwoFloat::new_sub(deflected.pairs_ahead, deflected.incoming_pair);
    let with_reliefs = equivalent_error(inputs);
    let equivalent_error =
        if inputs.method.shares_load() { pitch_error(inputs) } else { with_reliefs };
    Ok(Deviation {
        equivalent_error,
        modification: modification(inputs),
        combined_deflection,
        neighbour_deflection: deflected.incoming_pair.into(),
        total: with_reliefs + combined_deflection + earliness(inputs),
    })
}

/// By how much the tip is earlier at a place of the face than in the mean, where misalignment and flank
/// lines leave the least gap, in m. 0 in methods that solve the face.
///
/// # Formula
/// ```text
/// e_z = mean of e(z) - least e(z)
/// ```
/// The pair ahead is taken to touch over the whole face: its displacement is δ and the mean gap. Where it
/// does not, the tip can be earlier.
///
/// # Source
/// The balance of springs of one stiffness over the face, in closed form.
pub(super) fn earliness(inputs: &Inputs) -> f64 {
    let face = inputs.face().filter(|_| inputs.method == Method::Exact);
    face.map_or(0.0, |face| {
        let (mean, least, _) = face.gaps();
        mean - least
    })
}

/// Equivalent error Δf, in m.
///
/// # Formula
/// ```text
/// paper:  Δf = f + (e_m − j_bn)/√2
/// others: Δf = f + e_m,   e_m = −(driven tip relief + driver root relief)
/// ```
/// f is the combined base pitch deviation, see [`pitch_error`].
///
/// # Source
/// Zhou & Chen 2014, Eqs. 1 and 2. The method `paper` scales modification and backlash with the
/// random errors, as printed. The other methods count e_m in full, because a ground relief is no
/// random error, and leave out j_bn: a backlash is the distance of the back flanks and does not
/// delay a drive flank under load.
fn equivalent_error(inputs: &Inputs) -> TwoFloat {
    match inputs.method {
        Method::Paper => {
            let scaled = modification(inputs) - TwoFloat::from(inputs.backlash);
            pitch_error(inputs) + scaled * twofloat::consts::FRAC_1_SQRT_2
        }
        _ => pitch_error(inputs) + modification(inputs),
    }
}

/// Modification e_m = −(driven tip relief + driver root relief), in m.
fn modification(inputs: &Inputs) -> TwoFloat {
    -TwoFloat::new_add(inputs.driven.tip_relief, inputs.driver.root_relief)
}

/// Combined base pitch deviation f of both gears, in m.
///
/// # Formula
/// ```text
/// independent: f = ±√(f_pb1² + f_pb2²)    2 f_pb/√2 for equal deviations
/// sum:         f = f_pb1 + f_pb2
/// ```
/// The root has the common sign of the deviations.
///
/// # Source
/// Zhou & Chen 2014, Eq. 1, for independent deviations. Deviations that are known add.
fn pitch_error(inputs: &Inputs) -> TwoFloat {
    let [driver, driven] = inputs.base_pitches();
    match inputs.effective_combination() {
        Combination::Sum => TwoFloat::new_add(driver, driven),
        Combination::Independent if driver.to_bits() == driven.to_bits() => {
            TwoFloat::from(2.0 * driver) * twofloat::consts::FRAC_1_SQRT_2
        }
        Combination::Independent => {
            let squares = TwoFloat::new_mul(driver, driver) + TwoFloat::new_mul(driven, driven);
            let size = squares.root();
            if driver + driven < 0.0 { -size } else { size }
        }
    }
}

/// Displacements along the line of action under the load with the incoming pair at E, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Deflected {
    /// Displacement of the pairs that carry the load, coupling included.
    pairs_ahead: f64,
    /// Displacement of the incoming pair by the forces on these pairs.
    incoming_pair: f64,
}

type Places = SmallVec<[ContactPlace; USUAL_PAIRS + 1]>;

/// Number of loaded pairs stored without allocation.
const USUAL_PAIRS: usize = 2;

/// The two parts of the combined deflection δ when the incoming pair is at E, in m. Builds the teeth
/// only if a pair is in contact at F.
///
/// # Formula
/// ```text
/// δ = x − Σ_k Q_0k F_k/b,   x = Σ_j Q_kj F_j/b,   Σ F_k = F0,   F_k >= 0
/// Q_kk = q1 + q2 + qH  of the pair at  N1E + k pb,  k = 1, 2, .. before B
/// ```
/// With a contact ratio below 2 only the pair at F, one base pitch after E, carries the load: δ =
/// (Q_11 − Q_01) F0/b. With a higher contact ratio several pairs share the load. Without coupling
/// (Q_kj = 0), and in the method `paper`, δ = F0/(b Σ 1/Q_kk). The load is at the contact, not moved
/// off a tip.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 3 and 4, with the compliances of Eqs. 54-56 instead of the curve in Fig. 3.
/// The paper has no displacement of neighbours.
///
/// # Errors
/// [`Refusal::ContactRatioBelowOne`] if no pair is in contact at F, [`Refusal::InterferenceAtEnd`] if
/// the only pair touches the driven gear inside its base circle, or the errors of the compliance.
pub(super) fn deflected<'t>(
    method: Method,
    geometry: &Geometry,
    teeth: impl FnOnce() -> Result<&'t Teeth, Refusal>,
    mesh_force: f64,
) -> Result<Deflected, Refusal> {
    let is_in_contact = |along: &f64| *along <= geometry.end && *along < geometry.tangent_length;
    let first = geometry.start + geometry.base_pitch;
    if !is_in_contact(&first) {
        if first <= geometry.end {
            let start = geometry.tangent_length - geometry.end;
            return Err(Refusal::InterferenceAtEnd { start });
        }
        let losses = geometry.tip_losses;
        let whole = geometry.end - geometry.start + losses.total;
        return Err(Refusal::ContactRatioBelowOne {
            ratio: geometry.contact_ratio,
            is_deflection_taken: !method.shares_load(),
            cut: losses.greatest.filter(|_| whole > geometry.base_pitch),
        });
    }
    let teeth = teeth()?;
    let ahead = std::iter::successors(Some(first), |along| Some(along + geometry.base_pitch));
    let loaded = std::iter::once(geometry.start).chain(ahead.take_while(is_in_contact));
    let place = |along| teeth.under(&ContactPlace::on_line_of_action(geometry, along), mesh_force);
    let places: Places = loaded.map(place).collect();
    in_plane(teeth, &places, (mesh_force, method != Method::Paper))
}

/// The two parts of the combined deflection of a pair in slices when the leading end of the incoming
/// tooth is at E, in m: the planes across the axis are independent and have one displacement.
///
/// # Formula
/// ```text
/// x = F0/∫ F_z/x_z dz/b,   x_z the displacement of a plane under F_z, as of a spur pair
/// ```
///
/// # Errors
/// [`Refusal::TotalContactRatioBelowOne`] if no other pair is in contact,
/// [`Refusal::InterferenceAtEnd`] if it is only inside the driven base circle, or the errors of the
/// compliance.
pub(super) fn deflected_over_face(
    face: &FaceInputs,
    geometry: &Geometry,
    teeth: &Teeth,
    mesh_force: f64,
) -> Result<Deflected, Refusal> {
    let (start, pitch) = (geometry.start, geometry.base_pitch);
    let length = geometry.end.min(geometry.tangent_length) - start;
    let advance = face.width * face.lead.abs();
    // Past N2 there is no involute.
    let is_on_path = |path: &f64| {
        *path > 0.0 && start + path <= geometry.end && start + path < geometry.tangent_length
    };
    // The plane in which the next pair is at a place of its path.
    let plane = |next: f64| {
        let ahead = std::iter::successors(Some(next), |path| Some(path + pitch));
        let ahead = ahead.take_while(|path| start + path <= geometry.end).filter(is_on_path);
        let places = std::iter::once(0.0).chain(ahead).map(|path| {
            let place = ContactPlace::on_line_of_action(geometry, start + path);
            teeth.under(&place, mesh_force)
        });
        let places: Places = places.collect();
        let is_loaded = places.len() > 1;
        is_loaded.then(|| in_plane(teeth, &places, (mesh_force, true))).transpose()
    };
    let mut stiffness = 0.0;
    // Parts of the face at which pairs come to the ends of the path.
    let pairs = (1..=((advance + length) / pitch) as u32).map(|pair| f64::from(pair) * pitch);
    let cuts = pairs.flat_map(|path| [path / advance, (path - length) / advance]);
    let inside = cuts.filter(|part| *part > 0.0 && *part < 1.0);
    for ends in distinct(inside.chain([0.0, 1.0]).collect(), 0.0).windows(2) {
        for (node, weight) in quadrature::nodes() {
            let part = ends[0] + node * (ends[1] - ends[0]);
            if let Some(plane) = plane(pitch - part * advance)? {
                stiffness += weight * (ends[1] - ends[0]) / plane.pairs_ahead;
            }
        }
    }
    if stiffness <= 0.0 && geometry.end >= geometry.tangent_length {
        return Err(Refusal::InterferenceAtEnd { start: geometry.tangent_length - geometry.end });
    }
    if stiffness <= 0.0 {
        let ratio = face.total_contact_ratio(geometry);
        return Err(Refusal::TotalContactRatioBelowOne { ratio });
    }
    let leading = if is_on_path(&pitch) { plane(pitch)? } else { None };
    let pushed = leading.map_or(0.0, |plane| plane.incoming_pair / plane.pairs_ahead);
    Ok(Deflected { pairs_ahead: 1.0 / stiffness, incoming_pair: pushed / stiffness })
}

/// The displacements of a plane across the axis if all places except the first carry the force.
fn in_plane(
    teeth: &Teeth,
    places: &[ContactPlace],
    (mesh_force, is_coupled): (f64, bool),
) -> Result<Deflected, Refusal> {
    let coupling = if is_coupled { teeth.coupling(&places[0], &places[1], 1)? } else { 0.0 };
    if coupling == 0.0 || places.len() == 2 {
        let stiffnesses =
            places[1..].iter().map(|place| Ok(1.0 / teeth.pair_at_load(place, mesh_force)?));
        let stiffness: f64 = stiffnesses.sum::<Result<_, Refusal>>()?;
        return Ok(Deflected {
            pairs_ahead: mesh_force / (teeth.width() * stiffness),
            incoming_pair: coupling * (mesh_force / teeth.width()),
        });
    }
    let pairs = teeth.pair_set(0, places, mesh_force)?;
    let pairs = pairs.widened(|ahead| if ahead == 0 { f64::INFINITY } else { 0.0 });
    let (pairs_ahead, forces) = pairs.shared(mesh_force / teeth.width());
    if !pairs_ahead.is_finite() {
        return Err(Refusal::IndefiniteCompliance);
    }
    Ok(Deflected { pairs_ahead, incoming_pair: pairs.pushed(0, &forces) })
}

impl Deviation {
    /// The equivalent error by the definition of another method, in m, for the comparison of two
    /// methods: `static` and `dynamic` exclude the reliefs, the other methods include them.
    pub fn equivalent_error_as_in(&self, own: Method, other: Method) -> f64 {
        match (own.shares_load(), other.shares_load()) {
            (true, false) => self.equivalent_error + self.modification,
            (false, true) if own == Method::Paper => {
                self.equivalent_error - self.modification * std::f64::consts::FRAC_1_SQRT_2
            }
            (false, true) => self.equivalent_error - self.modification,
            _ => self.equivalent_error,
        }
    }

    /// Deflection of the pairs that carry the load, in m.
    pub fn loaded_deflection(&self) -> f64 {
        self.combined_deflection + self.neighbour_deflection
    }
}

impl<T: Real> Deviation<T> {
    pub(super) fn rounded(self) -> Deviation {
        Deviation {
            equivalent_error: self.equivalent_error.rounded(),
            modification: self.modification.rounded(),
            combined_deflection: self.combined_deflection.rounded(),
            neighbour_deflection: self.neighbour_deflection.rounded(),
            total: self.total.rounded(),
        }
    }
}

/// Source of a gear's base pitch deviation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The gear's own value.
    Own,
    /// The gear's flank tolerance class.
    Grade,
    /// The value that both gears share.
    Common,
}

/// Why ISO 1328-1:2013 does not cover a gear, or `None` if it does.
pub fn out_of_range(module: f64, teeth: u32) -> Option<&'static str> {
    let diameter = module * f64::from(teeth);
    if !(0.5e-3..=70e-3).contains(&module) {
        Some("modules from 0.5 to 70 mm")
    } else if !(5e-3..=15.0).contains(&diameter) {
        Some("reference diameters from 5 to 15000 mm")
    } else {
        None
    }
}

impl Inputs {
    /// Base pitch deviation f_pb of a gear of the pair, in m, and its source. The gear's own value
    /// has priority over its flank tolerance class, and the class over the common value.
    ///
    /// # Formula
    /// ```text
    /// f_pb = f_pT cos α_t  for a flank tolerance class
    /// ```
    pub fn base_pitch_of(&self, gear: &Gear) -> (f64, Origin) {
        match (gear.base_pitch, gear.grade) {
            (Some(own), _) => (own, Origin::Own),
            (None, Some(grade)) => {
                let (module, angle) = (self.transverse_module(), self.transverse_pressure_angle());
                let diameter = module * f64::from(gear.teeth);
                let allowed = base_pitch_tolerance(grade, self.module, diameter, angle);
                (gear.sampled_pitch.unwrap_or(allowed), Origin::Grade)
            }
            (None, None) => (self.base_pitch_deviation, Origin::Common),
        }
    }

    /// Single pitch deviation f_pT of a gear's flank tolerance class, in m.
    pub fn graded_pitch(&self, gear: &Gear) -> Option<f64> {
        let diameter = self.transverse_module() * f64::from(gear.teeth);
        Some(pitch_tolerance(gear.grade?, self.module, diameter))
    }

    /// Base pitch deviations of driver and driven gear, in m.
    pub fn base_pitches(&self) -> [f64; 2] {
        [&self.driver, &self.driven].map(|gear| self.base_pitch_of(gear).0)
    }

    /// How the base pitch deviations add. Deviations of unlike sign are known with their signs, so
    /// that they add.
    pub fn effective_combination(&self) -> Combination {
        let [driver, driven] = self.base_pitches();
        if driver * driven < 0.0 { Combination::Sum } else { self.combination }
    }

    /// The common base pitch deviation of both gears whose combined deviation is that of this pair
    /// plus `more`, in m.
    pub fn common_base_pitch(&self, more: f64) -> f64 {
        let error = pitch_error(self).rounded();
        let times = match self.combination {
            Combination::Independent => SQRT_2,
            Combination::Sum => 2.0,
        };
        (error + more) / times
    }

    /// Whether a gear has its own base pitch deviation or flank tolerance class.
    pub fn has_own_base_pitch(&self) -> bool {
        [&self.driver, &self.driven]
            .into_iter()
            .any(|gear| self.base_pitch_of(gear).1 != Origin::Common)
    }
}

/// The flank tolerance classes of the standard.
pub const TOLERANCE_CLASSES: RangeInclusive<u32> = 1..=11;

const MICROMETRES: f64 = 1e6;
const MILLIMETRES: f64 = 1e3;

/// Single pitch tolerance f_pT of a gear with the module m and the reference diameter d, both in m.
/// The result is in m.
///
/// # Formula
/// ```text
/// f_pT = (0.001 d + 0.4 m + 5) 2^((A − 5)/2)   in µm, with d and m in mm
/// ```
/// A is the class. The result is rounded to 1 µm above 10 µm, to 0.5 µm from 5 µm on, otherwise to
/// 0.1 µm.
///
/// # Source
/// ISO 1328-1:2013, section 5.
pub fn pitch_tolerance(class: u32, module: f64, diameter: f64) -> f64 {
    tolerance(class, 0.001 * diameter * MILLIMETRES + 0.4 * module * MILLIMETRES + 5.0)
}

/// Profile form tolerance f_fαT of a gear with the module m in m: (0.55 m + 5) 2^((A − 5)/2) in µm,
/// with m in mm, rounded as f_pT. The result is in m (ISO 1328-1:2013, section 5).
pub fn form_tolerance(class: u32, module: f64) -> f64 {
    tolerance(class, 0.55 * module * MILLIMETRES + 5.0)
}

/// The tolerance of a class, in m, from that of class 5 in µm.
fn tolerance(class: u32, fifth: f64) -> f64 {
    let exact = fifth * (0.5 * (f64::from(class) - 5.0)).exp2();
    let step = match exact {
        _ if exact > 10.0 => 1.0,
        _ if exact >= 5.0 => 2.0,
        _ => 10.0,
    };
    (exact * step).round() / step / MICROMETRES
}

/// Base pitch tolerance f_pb = f_pT cos α_t, in m.
pub fn base_pitch_tolerance(class: u32, module: f64, diameter: f64, pressure_angle: f64) -> f64 {
    pitch_tolerance(class, module, diameter) * pressure_angle.cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Drive;
    use crate::model::{Stage, Stages, solve};

    #[test]
    fn the_own_value_replaces_the_class_and_the_class_replaces_the_common_value() {
        let mut inputs = crate::model::sample::standard_pair(20, 20, 5e-3);
        inputs.base_pitch_deviation = 3e-6;
        let bits = |inputs: &crate::model::Inputs| inputs.base_pitches().map(f64::to_bits);
        let of = |values: [f64; 2]| values.map(f64::to_bits);
        assert_eq!(bits(&inputs), of([3e-6, 3e-6]));
        inputs.driver.grade = Some(7);
        let by_grade = 14e-6 * 20f64.to_radians().cos();
        assert_eq!(bits(&inputs), of([by_grade, 3e-6]));
        inputs.driver.base_pitch = Some(5e-6);
        assert_eq!(bits(&inputs), of([5e-6, 3e-6]));
    }

    /// Where all slices of the pair ahead touch, the balance has the same displacement.
    #[test]
    fn misalignment_and_crowning_make_a_tip_as_early_as_in_the_balance() {
        for (misalignment, crowning) in [(5e-6, 0.0), (10e-6, 0.0), (0.0, 6e-6), (-5e-6, 3e-6)] {
            let mut inputs = crate::model::sample::standard_pair(20, 35, 3e-3);
            (inputs.driver.face_width, inputs.driven.face_width) = (15e-3, 15e-3);
            inputs.drive = Drive::Torque(180.0);
            (inputs.misalignment, inputs.driven.crowning) = (misalignment, crowning);
            let by = |method: Method| {
                let wanted = Stages::of(Stage::Position).and(Stages::of(Stage::Static));
                solve(&Inputs { method, ..inputs.clone() }, wanted).unwrap()
            };
            let exact = by(Method::Exact).position.unwrap().approach_angle_driven;
            let balanced = by(Method::Static).static_load.unwrap().first_contact_angle.unwrap();
            assert!((exact / balanced - 1.0).abs() < 0.02, "{exact} for {balanced}");
        }
    }

    #[test]
    fn tolerances_agree_with_the_standard() {
        for (class, module, diameter, micrometres) in
            [(5, 2e-3, 0.1, 6.0), (6, 2e-3, 0.1, 8.5), (7, 5e-3, 0.1, 14.0), (1, 1e-3, 0.02, 1.4)]
        {
            let allowed = pitch_tolerance(class, module, diameter);
            assert!((allowed * 1e6 - micrometres).abs() < 1e-9, "{class}: {allowed}");
        }
    }
}
