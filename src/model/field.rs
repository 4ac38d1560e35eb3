//! Compliance of a gear's teeth and body, from plane-strain finite elements on the whole gear.

mod element;
mod fit;
mod mesh;
mod mode;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::geometry::{Circles, GearShape};
use super::inputs::{Gear, Inputs};
pub use super::limits::FieldRefusal;
use super::limits::POISSON;
use super::profile::{Profile, RACK_ROUNDING, Rack};
use super::{Refusal, geometry};
use crate::numeric::real::Lanes;
use element::{Load, Material};
use fit::{Abscissa, CrossSeries, Flank, Interpolation, Series};
use mesh::{Boundary, Grading, Mesh};
use mode::{Displacements, Mode};

/// Greatest distance, in pitches, at which a force on one tooth displaces another. Pairs in contact
/// are not farther apart if the contact ratio is below 4.
pub const PITCHES: usize = 3;

/// Input of the field of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldInput {
    /// Profile of its teeth.
    pub profile: Profile,
    /// Number of teeth z; of a virtual gear any number.
    pub teeth: f64,
    /// Module m, in m.
    pub module: f64,
    /// Bore radius r_h at which the body is clamped, in m; 0 for a gear without a bore.
    pub bore_radius: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
}

/// The solved finite elements of a gear, for Young's modulus 1 and unit face width. A value divided by E is
/// a compliance in m²/N: the displacement in m for a load in N/m.
///
/// A load acts on a flank at a radius, along the tangent to the base circle. Displacements are
/// along the same tangent of the tooth on which they are measured. They exclude the twist of the
/// body about its bore, and without a bore the shift of the body.
///
/// Radii outside of [`Field::radii`] use the nearest radius inside, so that the patch of a load
/// does not extend beyond the tip's corner.
///
/// # Source
/// Finite elements on half a tooth pitch with cyclic symmetry: Thomas 1979 ("Dynamics of
/// rotationally periodic structures").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    flank: Flank,
    /// The abscissas of the surface's series and of the other series.
    abscissas: [Abscissa; 2],
    /// Module, in m.
    module: f64,
    poisson: f64,
    /// Roll angle minus the force's angle to the normal of the centre line, in rad.
    base_half_angle: f64,
    twist: Option<f64>,
    /// Displacement at the centre of a patch of unit half width in modules.
    surface: Series,
    /// Displacement on the centre line under a patch of width 0.
    depth: Series,
    /// Displacement of teeth behind the load.
    cross: [CrossSeries; PITCHES],
}

impl Field {
    /// The field of a gear.
    ///
    /// # Errors
    /// A [`FieldRefusal`] if the gear has no tooth, flank or rim for the elements.
    pub fn build(input: &FieldInput) -> Result<Field, FieldRefusal> {
        Field::graded(input, &Grading::STANDARD)
    }

    /// Checks whether the elements fit the gear, without computing displacements.
    ///
    /// # Errors
    /// Those of [`Field::build`] except [`FieldRefusal::NotPositive`].
    pub fn check(input: &FieldInput) -> Result<(), FieldRefusal> {
        check(input, &Grading::STANDARD)
    }

    fn graded(input: &FieldInput, grading: &Grading) -> Result<Field, FieldRefusal> {
        let boundary = boundary(input)?;
        let (loads, values) = without_twist(input, &boundary, grading)?;
        Ok(Field::fitted(input, &boundary, &loads, &values))
    }

    /// The displacement under a load at the crossing of the line of force and the centre line of
    /// the tooth: tooth and body without the contact.
    ///
    /// `half_width` of the elliptical patch is in m and can be 0.
    ///
    /// # Formula
    /// ```text
    /// q(a) = q(0) − (1 + ν)(2 − ν)/(4π h²) a²
    /// ```
    /// h is the depth of the centre line below the flank, along the force.
    pub fn depth(&self, radius: f64, half_width: f64) -> f64 {
        let roll = self.flank.roll(radius);
        let share = half_width / self.centre_depth(radius);
        self.depth.at(self.abscissas[1].at(roll)) - depth_loss(self.poisson) * share * share
    }

    /// The displacement at the centre of the elliptical patch of a load, contact included.
    /// `half_width` is in m and above 0.
    ///
    /// # Formula
    /// ```text
    /// q(a) = q(m) + 2 (1 − ν²)/π ln(m/a)
    /// ```
    pub fn surface(&self, radius: f64, half_width: f64) -> f64 {
        let roll = self.flank.roll(radius);
        self.surface.at(self.abscissas[0].at(roll))
            + surface_slope(self.poisson) * (self.module / half_width).ln()
    }

    /// Decrease of the displacement under a patch per unit of ln a.
    ///
    /// # Formula
    /// ```text
    /// 2 (1 − ν²)/π
    /// ```
    pub fn surface_slope(&self) -> f64 {
        surface_slope(self.poisson)
    }

    /// The displacement at radius `measured` of the tooth `pitches` ahead of the tooth loaded at
    /// radius `loaded`. Teeth in the direction of the force are ahead; teeth behind have negative
    /// numbers.
    ///
    /// 0 for the loaded tooth itself, and for teeth more than [`PITCHES`] away.
    pub fn cross(&self, loaded: f64, measured: f64, pitches: i32) -> f64 {
        let at = |radius: f64| Lanes([self.abscissa(radius)]);
        let Lanes([found]) = self.cross_at([at(loaded), at(measured)], pitches);
        found
    }

    /// The same by the [abscissas](Field::abscissa) of load and displacement, several side by side.
    pub fn cross_at<const L: usize>(
        &self,
        [loaded, measured]: [Lanes<L>; 2],
        pitches: i32,
    ) -> Lanes<L> {
        let series = self.cross.get((pitches.unsigned_abs() as usize).wrapping_sub(1));
        series.map_or(Lanes::all(0.0), |series| {
            if pitches < 0 { series.at(loaded, measured) } else { series.at(measured, loaded) }
        })
    }

    /// The place at a radius in which displacements of other teeth are smooth, from −1 at the tip's
    /// load to 1 at the junction of fillet and involute.
    pub fn abscissa(&self, radius: f64) -> f64 {
        self.abscissas[1].at(self.flank.roll(radius))
    }

    /// The radius of the load whose pressure over ± `half_width`, in m, ends at the tip's corner,
    /// at most the radius of the load next to the tip.
    ///
    /// # Formula
    /// ```text
    /// r² = rb² + La² − 2 rb a
    /// ```
    /// La is the length of the tangent from the base circle to the corner. The arc length of an
    /// involute is L²/(2 rb).
    pub fn last_radius(&self, half_width: f64) -> f64 {
        let ([form, last], base) = (self.radii(), self.flank.base);
        let corner = base * self.flank.tip_roll;
        let tangent = (corner * corner - 2.0 * base * half_width).max(0.0).sqrt();
        base.hypot(tangent).clamp(form, last)
    }

    /// The radii from the junction of fillet and involute to the load next to the tip, in m.
    pub fn radii(&self) -> [f64; 2] {
        self.flank.radii
    }

    /// The displacement of all teeth by the twist of the body about its bore, which the other
    /// values exclude. `None` without a bore.
    pub fn twist(&self) -> Option<f64> {
        self.twist
    }

    /// Depth of the centre line below the flank at a radius along the force, in m. The contact is
    /// inside the tooth if its half-width is smaller.
    pub fn centre_depth(&self, radius: f64) -> f64 {
        self.module * self.depth_in_modules(self.flank.roll(radius))
    }

    /// Depth of the centre line below the flank along the force, in modules.
    fn depth_in_modules(&self, roll: f64) -> f64 {
        let angle = roll - self.base_half_angle;
        self.flank.base / self.module * (roll - angle.tan())
    }

    fn fitted(
        input: &FieldInput,
        boundary: &Boundary,
        loads: &[Load],
        values: &Displacements,
    ) -> Field {
        /// Lengths of δ and ε, in modules, for the series of the surface and for the others.
        const BEYOND: [[f64; 2]; 2] = [[0.1, 1.0], [0.2, 1.5]];
        let rolls = [loads[loads.len() - 1].roll, loads[0].roll];
        let flank = Flank::of(input.module * boundary.base, boundary.tip_roll, rolls);
        let abscissas =
            BEYOND.map(|beyond| Abscissa::of(&flank, beyond.map(|length| length * input.module)));
        let [steep, smooth] = abscissas.each_ref().map(|abscissa| {
            Interpolation::new(loads.iter().map(|load| abscissa.at(load.roll)).collect())
        });
        let per_load = |values: &[f64], extra: &dyn Fn(&Load) -> f64| -> Vec<f64> {
            let pairs = values.iter().zip(loads);
            pairs.map(|(value, load)| value + extra(load)).collect()
        };
        let surface =
            per_load(&values.surface, &|load| surface_slope(input.poisson) * load.half_width.ln());
        let depth = per_load(&values.centre, &|load| {
            depth_loss(input.poisson) * (load.half_width / load.depth).powi(2)
        });
        Field {
            flank,
            abscissas,
            module: input.module,
            poisson: input.poisson,
            base_half_angle: input.profile.base_half_angle(),
            twist: (input.bore_radius > 0.0).then(|| {
                let bore = input.bore_radius / input.module;
                body_twist(boundary.base, boundary.root, bore, input.poisson)
            }),
            surface: steep.series(&surface),
            depth: smooth.series(&depth),
            cross: values.cross.each_ref().map(|cross| smooth.cross_series(cross)),
        }
    }
}

/// 2 (1 − ν²)/π.
fn surface_slope(poisson: f64) -> f64 {
    2.0 * (1.0 - poisson * poisson) / PI
}

/// (1 + ν)(2 − ν)/(4π).
fn depth_loss(poisson: f64) -> f64 {
    (1.0 + poisson) * (2.0 - poisson) / (4.0 * PI)
}

/// Greatest number of cached gears, 2 kB each. A new gear replaces the least recently used one.
const MOST_GEARS: usize = 256;

/// The inputs of a gear's compliance besides its circles. The field does not depend on Young's
/// modulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticGear {
    /// The rack that cuts the profile.
    pub rack: Rack,
    /// Shape of the gear.
    pub shape: GearShape,
    /// Bore radius r_h, in m; 0 without a bore.
    pub bore_radius: f64,
    /// Young's modulus E, in Pa.
    pub young: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// 1/cos β_b: the compliance of the transverse section over that of the normal section.
    pub oblique: f64,
    /// Radius of a point of this gear minus that of the point at the same height on the gear of the
    /// pair, in m; 0 for a spur gear.
    pub rise: f64,
}

impl ElasticGear {
    /// A gear of the pair; of a helical gear, the virtual spur gear of its normal section.
    ///
    /// # Formula
    /// ```text
    /// q = q_n/cos β_b,   z_n = z/(cos² β_b cos β)
    /// ```
    /// q_n is the compliance of the gear with z_n teeth, the normal module and pressure angle, the
    /// same heights and the same rim, under a load at the same height. The force on the transverse
    /// width is that on the length of the contact line, and the displacement in the transverse plane is
    /// that along the normal over cos β_b.
    ///
    /// # Source
    /// ISO 21771:2007 for z_n; ISO 6336-1:2019, 9.2 has cos β in place of cos β_b.
    ///
    /// # Valid for
    /// Helix angles up to 30 deg: own finite elements in three dimensions give 1.02 to 1.06 times
    /// these compliances, as they do for spur gears.
    pub fn of(inputs: &Inputs, gear: &Gear) -> ElasticGear {
        // The rounding of the tip moves the load but does not change the stiffness of the tooth.
        let shape = GearShape { tip_radius: None, ..inputs.gear_shape(gear) };
        let (rack, bore_radius) = (Rack::of(inputs, gear), gear.bore_radius);
        let Gear { young, poisson, .. } = *gear;
        let spur =
            ElasticGear { rack, shape, bore_radius, young, poisson, oblique: 1.0, rise: 0.0 };
        if inputs.helix_angle == 0.0 {
            return spur;
        }
        let (teeth, cosine) = (f64::from(gear.teeth), inputs.base_helix_angle().cos());
        let virtual_teeth = inputs.virtual_teeth(gear);
        let rise = 0.5 * (inputs.module * virtual_teeth - inputs.transverse_module() * teeth);
        let tip_chamfer = gear.tip_chamfer;
        let (addendum, dedendum) = (inputs.addendum_of(gear), inputs.dedendum_of(gear));
        let (teeth, profile_shift) = (virtual_teeth, gear.profile_shift);
        ElasticGear {
            rack: Rack {
                module: inputs.module,
                pressure_angle: inputs.pressure_angle,
                teeth,
                profile_shift,
                dedendum,
                rounding: RACK_ROUNDING,
            },
            shape: GearShape {
                teeth,
                profile_shift,
                addendum,
                tip_diameter: None,
                dedendum,
                root_diameter: None,
                tip_chamfer,
                tip_radius: None,
            },
            bore_radius: if bore_radius > 0.0 { bore_radius + rise } else { 0.0 },
            oblique: cosine.recip(),
            rise,
            ..spur
        }
    }

    /// The circles of the gear. Those of a spur gear of the pair are given.
    ///
    /// # Errors
    /// Those of [`geometry::circles`].
    pub fn circles(&self, of_pair: &Circles) -> Result<Circles, Refusal> {
        if self.oblique > 1.0 {
            geometry::circles(self.rack.module, self.rack.pressure_angle, &self.shape)
        } else {
            Ok(*of_pair)
        }
    }

    /// The field of the gear, built if no recent solve has built it.
    ///
    /// # Formula
    /// ```text
    /// q(r; a) = q(r) + q_H(r; m) + 2 (1 − ν²)/(π E) ln(m/a)
    /// ```
    /// q is the displacement of the tooth's centre line along a force at radius r. q_H is the
    /// additional displacement of the flank under an elliptical pressure over ± a.
    ///
    /// # Source
    /// [`Field`]: finite elements on half a pitch of the whole gear, in plane strain.
    ///
    /// # Valid for
    /// A flank above the form circle. A load within 0.02 modules of the tip's corner acts at this
    /// distance. Under the mesh force the distance is at least the half-width of the contact, so that
    /// the pressure ends at the corner ([`Teeth::under`](super::compliance::Teeth::under)). An impact uses the 0.02 modules.
    ///
    /// # Errors
    /// [`Refusal::NoField`] if the gear has no field, and the refusals of its circles.
    pub fn field(&self) -> Result<Arc<Field>, Refusal> {
        let entry = self.entry();
        // The list is not locked while a field is built, so that other gears do not wait.
        entry.field.get_or_init(|| self.build_field().map(Arc::new)).clone()
    }

    /// The field of the gear, built without the cache.
    ///
    /// # Errors
    /// Those of [`ElasticGear::field`].
    pub fn build_field(&self) -> Result<Field, Refusal> {
        Field::build(&self.input()?).map_err(|reason| self.refusal(reason))
    }

    /// Whether the gear has a field, without building it.
    ///
    /// # Errors
    /// Those of [`ElasticGear::field`].
    pub fn check_field(&self) -> Result<(), Refusal> {
        let check = || Field::check(&self.input()?).map_err(|reason| self.refusal(reason));
        *self.entry().check.get_or_init(check)
    }

    fn input(&self) -> Result<FieldInput, Refusal> {
        let (module, alpha) = (self.rack.module, self.rack.pressure_angle);
        let circles = geometry::circles(module, alpha, &self.shape)?;
        Ok(FieldInput {
            profile: Profile::of(&self.rack, &circles),
            teeth: self.rack.teeth,
            module,
            bore_radius: self.bore_radius,
            poisson: self.poisson,
        })
    }

    fn refusal(&self, reason: FieldRefusal) -> Refusal {
        Refusal::NoField { teeth: self.rack.teeth, reason }
    }

    /// The entry of the gear.
    fn entry(&self) -> Arc<Entry> {
        let gear = ElasticGear { young: 1.0, ..*self };
        let mut entries = RECENT.lock().unwrap_or_else(PoisonError::into_inner);
        let known = entries.iter().rposition(|entry| entry.gear == gear);
        let entry = match known {
            Some(at) => entries.remove(at),
            None => Arc::new(Entry { gear, check: OnceLock::new(), field: OnceLock::new() }),
        };
        if entries.len() == MOST_GEARS {
            entries.remove(0);
        }
        entries.push(Arc::clone(&entry));
        entry
    }
}

/// A gear with a Young's modulus of 1 and its field after the first request.
struct Entry {
    gear: ElasticGear,
    check: OnceLock<Result<(), Refusal>>,
    field: OnceLock<Result<Arc<Field>, Refusal>>,
}

/// Recent gears, the most recently used one last. A field depends only on its gear, and building
/// takes thousands of times as long as reading.
static RECENT: Mutex<Vec<Arc<Entry>>> = Mutex::new(Vec::new());

/// Least thickness of the rim, in modules.
const LEAST_RIM: f64 = 1e-3;

/// The boundary of a gear, checked for the mesh.
fn boundary(input: &FieldInput) -> Result<Boundary, FieldRefusal> {
    let boundary = Boundary::of(input)?;
    // The displacements are measured on the centre line, that of the lowest load at this radius.
    let lowest = boundary.base / boundary.load_angle(boundary.junction_roll).cos();
    let (thickness, least) = (
        boundary.root * input.module - input.bore_radius,
        ((boundary.root - lowest).max(0.0) + LEAST_RIM) * input.module,
    );
    if thickness.is_nan() || thickness < least {
        return Err(FieldRefusal::ThinRim { thickness, least });
    }
    if !(POISSON.0..=POISSON.1).contains(&input.poisson) {
        return Err(FieldRefusal::Poisson { poisson: input.poisson });
    }
    Ok(boundary)
}

/// Refuses a gear whose outline folds the elements.
fn check(input: &FieldInput, grading: &Grading) -> Result<(), FieldRefusal> {
    let boundary = boundary(input)?;
    let bore = input.bore_radius / input.module;
    let bores = if is_extrapolated(bore, &boundary) {
        RATIOS.map(|ratio| boundary.root / ratio).to_vec()
    } else {
        vec![bore]
    };
    for bore in bores {
        let mesh = Mesh::of(&boundary, bore, grading);
        let elements = mesh.elements.iter();
        let folds = |nodes: &mesh::Nodes| element::folds(&nodes.map(|node| mesh.places[node]));
        if let Some((element, _)) = elements.enumerate().find(|(_, nodes)| folds(nodes)) {
            return Err(folded(element, &mesh));
        }
    }
    Ok(())
}

fn folded(element: usize, mesh: &Mesh) -> FieldRefusal {
    FieldRefusal::FoldedMesh { element, count: mesh.elements.len() }
}

/// Two ratios r_f/r_h from which the field of a smaller bore is extrapolated.
const RATIOS: [f64; 2] = [5.0, 7.0];

/// Whether the field of a bore in modules is extrapolated from larger bores.
fn is_extrapolated(bore: f64, boundary: &Boundary) -> bool {
    bore * RATIOS[1] < boundary.root
}

/// The displacements without the twist of the body, and for a gear without a bore without its
/// shift.
///
/// A small bore affects the field only by twist and shift, up to the square of its radius. Its
/// field is extrapolated from two larger bores, because the twist would be most of the result.
fn without_twist(
    input: &FieldInput,
    boundary: &Boundary,
    grading: &Grading,
) -> Result<(Vec<Load>, Displacements), FieldRefusal> {
    let bore = input.bore_radius / input.module;
    if !is_extrapolated(bore, boundary) {
        return solved(input, boundary, bore, grading);
    }
    let (loads, mut far) = solved(input, boundary, boundary.root / RATIOS[0], grading)?;
    let (_, mut near) = solved(input, boundary, boundary.root / RATIOS[1], grading)?;
    add_shift(&mut far, &loads, input, -RATIOS[0].ln());
    add_shift(&mut near, &loads, input, -RATIOS[1].ln());
    let [outer, inner] = RATIOS.map(|ratio| 1.0 / (ratio * ratio));
    let share = ((bore / boundary.root).powi(2) - inner) / (outer - inner);
    let mut values = near;
    for (value, far) in all(&mut values).zip(all(&mut far)) {
        *value += share * (*far - *value);
    }
    if bore > 0.0 {
        add_shift(&mut values, &loads, input, (boundary.root / bore).ln());
    }
    Ok((loads, values))
}

/// All displacements.
fn all(values: &mut Displacements) -> impl Iterator<Item = &mut f64> {
    let own = values.surface.iter_mut().chain(&mut values.centre);
    own.chain(values.cross.iter_mut().flatten())
}

/// Adds the body's shift for ln(r_f/r_h).
fn add_shift(values: &mut Displacements, loads: &[Load], input: &FieldInput, logarithm: f64) {
    let shift = body_shift(input.poisson) * logarithm;
    for value in values.surface.iter_mut().chain(&mut values.centre) {
        *value += shift;
    }
    for (pitches, cross) in (1..).zip(&mut values.cross) {
        let turn = 2.0 * PI * f64::from(pitches) / input.teeth;
        let pairs = loads.iter().flat_map(|load| loads.iter().map(move |other| (load, other)));
        for (value, (load, measured)) in cross.iter_mut().zip(pairs) {
            *value += shift * (turn + load.angle - measured.angle).cos();
        }
    }
}

/// The loads of the mesh, and the displacements under them for a bore in modules.
fn solved(
    input: &FieldInput,
    boundary: &Boundary,
    bore: f64,
    grading: &Grading,
) -> Result<(Vec<Load>, Displacements), FieldRefusal> {
    let mesh = Mesh::of(boundary, bore, grading);
    let places = mesh.loads.iter();
    let loads: Vec<_> = places.map(|place| Load::at(&mesh, boundary, place)).collect();
    let mut values = under_loads(input, boundary, &mesh, &loads)?;
    let twist = body_twist(boundary.base, boundary.root, bore, input.poisson);
    for value in all(&mut values) {
        *value -= twist;
    }
    Ok((loads, values))
}

/// The displacements under the loads of the mesh, twist included.
fn under_loads(
    input: &FieldInput,
    boundary: &Boundary,
    mesh: &Mesh,
    loads: &[Load],
) -> Result<Displacements, FieldRefusal> {
    let stiffnesses = stiffnesses(mesh, boundary, input.poisson)?;
    let condense = |mode| mode::condense(mesh, &stiffnesses, loads, mode);
    let solve = || {
        let (even, odd) = (condense(Mode::Symmetric)?, condense(Mode::Antisymmetric)?);
        mode::displacements(&even, &odd, loads, input.teeth)
    };
    solve().ok_or(FieldRefusal::NotPositive { unknowns: 2 * mesh.places.len() })
}

/// The stiffnesses of the elements, with radial and tangential components on the cut.
fn stiffnesses(
    mesh: &Mesh,
    boundary: &Boundary,
    poisson: f64,
) -> Result<Vec<element::Stiffness>, FieldRefusal> {
    let material = Material::of(poisson);
    let cut = mesh.inner()..mesh.inner() + mesh.on_cut();
    let mut stiffnesses = Vec::with_capacity(mesh.elements.len());
    for (index, nodes) in mesh.elements.iter().enumerate() {
        let places = nodes.map(|node| mesh.places[node]);
        let mut stiffness =
            element::stiffness(&places, material).ok_or_else(|| folded(index, mesh))?;
        let is_on_cut = nodes.map(|node| cut.contains(&node));
        mode::turn(&mut stiffness, is_on_cut, boundary.half_pitch);
        element::take_middle_out(&mut stiffness);
        stiffnesses.push(stiffness);
    }
    Ok(stiffnesses)
}

/// Displacement of all teeth along the line of action from the body's twist about its clamped
/// bore, dimensionless: per force and face width, times Young's modulus. Radii in m.
///
/// # Formula
/// ```text
/// r_b² (1 + ν)/(2π) (1/r_h² − 1/r_f²)
/// ```
///
/// # Source
/// A ring under shear at its rim (Timoshenko & Goodier, "Theory of Elasticity").
///
/// # Valid for
/// 0 < r_h < r_f.
pub fn body_twist(base: f64, root: f64, bore: f64, poisson: f64) -> f64 {
    base * base * (1.0 + poisson) / (2.0 * PI) * (root - bore) * (root + bore)
        / (bore * root * bore * root)
}

/// Displacement of the body along the net force for each unit of ln(r_f/r_h), dimensionless: per
/// force and face width, times Young's modulus.
///
/// # Formula
/// ```text
/// (3 − 4ν)(1 + ν)/(4π (1 − ν))
/// ```
///
/// # Source
/// A line load in plane strain (Kelvin's solution, Timoshenko & Goodier, "Theory of Elasticity").
///
/// # Valid for
/// 0 <= ν < 1/2.
pub fn body_shift(poisson: f64) -> f64 {
    (3.0 - 4.0 * poisson) * (1.0 + poisson) / (4.0 * PI * (1.0 - poisson))
}
