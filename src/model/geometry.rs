//! Involute geometry of the pair: circles, line of action, start of contact, and the force along the
//! line of action.

use nalgebra::Vector2;
use twofloat::TwoFloat;

use super::Refusal;
use super::inputs::{Gear, GearSide, Inputs, Method};
use super::limits::Member;
use crate::numeric::Real;

/// A difference below this part of its terms is computed in double-double arithmetic, because f64
/// would lose two or more digits.
pub(super) const LEAST_REST: f64 = 1.0 / 64.0;

/// Geometry of the pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry<T = f64> {
    /// Transmission ratio i = z₂/z₁.
    pub ratio: T,
    /// Circles of the driver.
    pub driver: Circles<T>,
    /// Circles of the driven gear.
    pub driven: Circles<T>,
    /// Centre distance a, in m.
    pub centre_distance: T,
    /// Working pressure angle α_w, in rad.
    pub working_pressure_angle: T,
    /// Base pitch p_b = π m cos α, in m.
    pub base_pitch: T,
    /// N₁E: from the driver's point of tangency to the start of contact, in m.
    pub start: T,
    /// N₁B: from the driver's point of tangency to the end of contact, in m.
    pub end: T,
    /// N₁N₂, in m.
    pub tangent_length: T,
    /// E to the pitch point: the path of approach, in m.
    pub approach_length: T,
    /// Contact ratio ε = EB/p_b.
    pub contact_ratio: T,
    /// The parts of the path of contact that chamfers and roundings of the tips remove.
    pub tip_losses: TipLosses,
    /// γ₂: angle at O₂ between the centre line and the tip at E, in rad. For a rounded tip, the
    /// centre of its arc replaces the tip.
    pub start_angle_driven: T,
    /// Sine and cosine of γ₂.
    pub start_direction_driven: Vector2<T>,
    /// The point E relative to O₁ with the centre line along x, in m. For a rounded tip, the centre
    /// of its arc.
    pub start_point: Vector2<T>,
}

/// Geometry of the pair, by ISO 21771.
///
/// # Formula
/// ```text
/// rb = r cos α,  ra = r + m (ha* + x) − chamfer,  pb = π m cos α
/// inv αw = inv α + 2 (x1 + x2) tan α/(z1 + z2)  without a given centre distance,
/// otherwise cos αw = (rb1 + rb2)/a
/// N1E = N1N2 − √(ra2² − rb2²),  N1B = √(ra1² − rb1²),  ε = (N1B − N1E)/pb
/// γ2 = ∠(O2O1, O2E)
/// ```
/// A rounded tip is an arc of radius re inside the tip circle, tangent to the tip circle and to the
/// flank. It ends the involute at the radius of curvature L_f instead of √(ra² − rb²). γ₂ and E are
/// those of the centre C of the arc:
/// ```text
/// rC = ra − re,  L_C = √(rC² − rb²),  L_f = L_C + re,  N1C = N1E + re
/// ```
/// inv t = tan t − t. The formulas avoid differences of squares: r_a − r_b = 2 r sin²(α/2) + m
/// (h_a* + x) and N₁N₂ = (r_b1 + r_b2) tan α_w.
///
/// # Source
/// ISO 21771:2007; Zhou & Chen 2014, Eqs. 8, 9 (γ₂), 16 and 20 (N₁E, here without the rounded
/// contact ratio).
///
/// # Errors
/// A [`Refusal`] if the pair has no line of action, a tip is inside its base circle, or the driven
/// tip would touch the driver below its base circle.
pub fn geometry<T: Real>(shape: &PairShape) -> Result<Geometry<T>, Refusal> {
    let alpha: T = shape.pressure_angle.into();
    let driver: Circles<T> = circles(shape.module, shape.pressure_angle, &shape.driver)?;
    let driven: Circles<T> =
        circles(shape.module, shape.pressure_angle, &shape.driven).map_err(Refusal::at_driven)?;
    let base_sum = driver.base + driven.base;
    let (centre_distance, tangent) = working_tangent(shape, alpha, base_sum)?;
    let tangent_length = base_sum * tangent;
    let start = tangent_length - driven.tip_curvature;
    if start <= T::zero() {
        return Err(Refusal::Interference { start: start.rounded() });
    }
    let base_pitch = T::PI * shape.module.into() * alpha.sine_cosine().1;
    let approach_length = driven.tip_curvature - driven.base * tangent;
    let (centre_approach, centre_curvature) =
        (approach_length - driven.edge, driven.tip_curvature - driven.edge);
    let working_pressure_angle = tangent.angle_to(T::one());
    let end = driver.tip_curvature;
    let tip_losses = tip_losses(shape, &driver.rounded(), &driven.rounded());
    if end <= start {
        let whole = (end - start).rounded() + tip_losses.total;
        return Err(Refusal::NoPath {
            start: start.rounded(),
            end: end.rounded(),
            is_distance_given: shape.centre_distance.is_some(),
            cut: tip_losses.greatest.filter(|_| whole > 0.0),
        });
    }
    let contact_ratio = (end - start).over(base_pitch);
    let towards_start = Vector2::new(centre_approach, driven.base + centre_curvature * tangent);
    let is_rounded = driver.edge > T::zero() || driven.edge > T::zero();
    if let Some(cut) = tip_losses.greatest.filter(|_| is_rounded)
        && contact_ratio < T::one()
    {
        return Err(Refusal::RoundingBreaksContact { cut, ratio: contact_ratio.rounded() });
    }
    Ok(Geometry {
        ratio: T::from(shape.driven.teeth).over(shape.driver.teeth.into()),
        driver,
        driven,
        centre_distance,
        working_pressure_angle,
        base_pitch,
        start,
        end,
        tangent_length,
        approach_length,
        contact_ratio,
        tip_losses,
        start_angle_driven: towards_start.x.angle_to(towards_start.y),
        start_direction_driven: towards_start
            * T::one().over(towards_start.dot(&towards_start).root()),
        start_point: foot(driver.base, start + driven.edge, working_pressure_angle),
    })
}

/// Geometry of the pair in double-double arithmetic, if the case requests it or small differences
/// of `plain` need it. `plain` is `None` if f64 cannot compute the geometry.
///
/// # Errors
/// Those of [`geometry`].
pub(super) fn precise(
    inputs: &Inputs,
    plain: Option<&Geometry>,
) -> Result<Option<Geometry<TwoFloat>>, Refusal> {
    let close_call = plain.is_none_or(|geometry| geometry.needs_precision(inputs.bores()));
    (inputs.accurate || close_call).then(|| geometry(&inputs.shape())).transpose()
}

/// tan t.
fn tangent_of<T: Real>(angle: T) -> T {
    let (sine, cosine) = angle.sine_cosine();
    sine.over(cosine)
}

/// The point of a flank with the radius of curvature `curvature` on a contact normal at `angle`,
/// relative to O₁.
pub(super) fn foot<T: Real>(base: T, curvature: T, angle: T) -> Vector2<T> {
    let (sine, cosine) = angle.sine_cosine();
    Vector2::new(cosine * base + sine * curvature, sine * base - cosine * curvature)
}

/// Centre distance and tan α_w.
fn working_tangent<T: Real>(shape: &PairShape, alpha: T, base_sum: T) -> Result<(T, T), Refusal> {
    if let Some(given) = shape.centre_distance {
        let distance: T = given.into();
        if distance <= base_sum {
            return Err(Refusal::CentreDistanceJams { distance: given, least: base_sum.rounded() });
        }
        return Ok((
            distance,
            ((distance - base_sum) * (distance + base_sum)).root().over(base_sum),
        ));
    }
    let angle = alpha + working_angle_rise(shape, alpha)?;
    let (sine, cosine) = angle.sine_cosine();
    Ok((base_sum.over(cosine), sine.over(cosine)))
}

/// α_w − α of the mesh without backlash, by Newton's method on the involute function.
///
/// The involute function is convex, so that steps from the right of the root stay on the right.
fn working_angle_rise<T: Real>(shape: &PairShape, alpha: T) -> Result<T, Refusal> {
    const LARGEST_ANGLE: f64 = 1.4;
    const STEPS: usize = 40;
    let (driver, driven) = (&shape.driver, &shape.driven);
    let two: T = 2.0.into();
    let tangent = tangent_of(alpha);
    let shifts = <T as From<f64>>::from(driver.profile_shift) + driven.profile_shift.into();
    let rise = (two * shifts * tangent).over(T::from(driver.teeth + driven.teeth));
    if tangent - alpha + rise <= T::zero() {
        return Err(Refusal::ShiftsLeaveNoMesh { sum: shifts.rounded() });
    }
    let largest = <T as From<f64>>::from(LARGEST_ANGLE) - alpha;
    let parabola = rise.over(tangent * tangent);
    let mut angle = if parabola < largest { parabola } else { largest };
    for _ in 0..STEPS {
        let step_tangent = tangent_of(angle);
        let opened =
            (step_tangent * (T::one() + tangent * tangent)).over(T::one() - tangent * step_tangent);
        let slope = (tangent + opened) * (tangent + opened);
        let step = (opened - angle - rise).over(slope);
        angle -= step;
        if step.rounded().abs() <= T::EPSILON {
            break;
        }
    }
    Ok(angle)
}

impl Geometry {
    /// The part of the path of contact, from −1 at E to 1 at B, of a contact with the load points at these distances from N₁ and N₂. Before E, where only
    /// the driven tip touches, and after B it is that of the end.
    pub fn part_of_path(&self, (driver, driven): (f64, f64)) -> f64 {
        /// Of the path: the two distances of a contact on the line of action differ less.
        const SAME: f64 = 1e-9;
        let length = self.end - self.start;
        let by_driver = driver - self.start;
        let by_driven = self.tangent_length - self.start - driven;
        let is_on_line = (by_driver - by_driven).abs() <= SAME * length;
        match by_driver + by_driven {
            sum if is_on_line => sum / length - 1.0,
            sum if sum < length => -1.0,
            _ => 1.0,
        }
    }

    /// Length of the path of contact with one additional pair in contact, (ε − ⌈ε⌉ + 1) p_b, in m.
    /// For 1 < ε < 2 this is the length of double contact at each end.
    pub fn shared_length(&self) -> f64 {
        (self.contact_ratio - self.contact_ratio.ceil() + 1.0) * self.base_pitch
    }

    /// Whether f64 loses digits in a small difference: N₁E, the path of contact, EP, r_a − r_b, a −
    /// (r_b1 + r_b2), the wall between bore and base circle, or ε − 1 with rounded tips.
    pub fn needs_precision(&self, bores: [f64; 2]) -> bool {
        const FLAT: f64 = 0.125;
        const SHORT: f64 = 1.0 / 32.0;
        let short_tip = |circles: &Circles| circles.tip_curvature < SHORT * circles.base;
        let thin_wall =
            |bore: f64, circles: &Circles| circles.base - bore < LEAST_REST * circles.base;
        self.start < LEAST_REST * self.tangent_length
            || self.approach_length.abs() < LEAST_REST * self.driven.tip_curvature
            || self.end - self.start < LEAST_REST * self.end
            || self.tangent_length < FLAT * (self.driver.base + self.driven.base)
            || short_tip(&self.driver)
            || short_tip(&self.driven)
            || thin_wall(bores[0], &self.driver)
            || thin_wall(bores[1], &self.driven)
            || self.is_rounded() && (self.contact_ratio - 1.0).abs() < LEAST_REST
    }

    fn is_rounded(&self) -> bool {
        self.driver.edge > 0.0 || self.driven.edge > 0.0
    }

    /// Normal backlash from the centre distance, 2 (r_b1 + r_b2) (inv α_w − inv α_w0), in m. α_w0
    /// is the working pressure angle without backlash. A negative value means that the teeth jam
    /// (ISO 21771).
    pub fn backlash(&self, shape: &PairShape) -> f64 {
        let alpha = shape.pressure_angle;
        let shifts = shape.driver.profile_shift + shape.driven.profile_shift;
        let without = involute(alpha)
            + 2.0 * shifts * alpha.tan() / (shape.driver.teeth + shape.driven.teeth);
        2.0 * (self.driver.base + self.driven.base)
            * (involute(self.working_pressure_angle) - without)
    }
}

/// inv t = tan t − t.
pub(super) fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

impl<T: Real> Geometry<T> {
    pub(super) fn rounded(self) -> Geometry {
        Geometry {
            ratio: self.ratio.rounded(),
            driver: self.driver.rounded(),
            driven: self.driven.rounded(),
            centre_distance: self.centre_distance.rounded(),
            working_pressure_angle: self.working_pressure_angle.rounded(),
            base_pitch: self.base_pitch.rounded(),
            start: self.start.rounded(),
            end: self.end.rounded(),
            tangent_length: self.tangent_length.rounded(),
            approach_length: self.approach_length.rounded(),
            contact_ratio: self.contact_ratio.rounded(),
            tip_losses: self.tip_losses,
            start_angle_driven: self.start_angle_driven.rounded(),
            start_direction_driven: self.start_direction_driven.map(Real::rounded),
            start_point: self.start_point.map(Real::rounded),
        }
    }
}

/// Shape of the pair in the transverse section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairShape {
    /// Transverse module m_t, in m.
    pub module: f64,
    /// Transverse pressure angle α_t, in rad.
    pub pressure_angle: f64,
    /// Centre distance a, in m; `None` for a mesh without backlash.
    pub centre_distance: Option<f64>,
    /// Shape of the driver.
    pub driver: GearShape,
    /// Shape of the driven gear.
    pub driven: GearShape,
}

/// Shape of one gear in the transverse section. Coefficients are times the transverse module.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearShape {
    /// Number of teeth z; of a virtual gear any number.
    pub teeth: f64,
    /// Profile shift coefficient x.
    pub profile_shift: f64,
    /// Addendum coefficient h_a*.
    pub addendum: f64,
    /// Tip diameter before the chamfer, in m, which replaces the coefficient.
    pub tip_diameter: Option<f64>,
    /// Dedendum coefficient h_fP*.
    pub dedendum: f64,
    /// Root diameter, in m, which replaces the coefficient.
    pub root_diameter: Option<f64>,
    /// Radial tip chamfer, in m.
    pub tip_chamfer: f64,
    /// Radius of the rounding of the tip's edge, in m; `None` for a sharp tip.
    pub tip_radius: Option<f64>,
}

impl Inputs {
    /// Addendum coefficient of a gear: h_a* = (d_a − m_t z)/(2 m_n) − x if the tip diameter is
    /// given, otherwise the given coefficient.
    pub fn addendum_of(&self, gear: &Gear) -> f64 {
        gear.tip_diameter
            .map_or(gear.addendum, |diameter| self.height_of(gear, diameter) - gear.profile_shift)
    }

    /// Dedendum coefficient of a gear: h_fP* = x − (d_f − m_t z)/(2 m_n) if the root diameter is
    /// given, otherwise the given coefficient.
    pub fn dedendum_of(&self, gear: &Gear) -> f64 {
        gear.root_diameter
            .map_or(gear.dedendum, |diameter| gear.profile_shift - self.height_of(gear, diameter))
    }

    /// Height of a circle above the reference circle, times the module.
    fn height_of(&self, gear: &Gear, diameter: f64) -> f64 {
        (diameter - self.transverse_module() * f64::from(gear.teeth)) / (2.0 * self.module)
    }

    /// Shape of a gear of the pair in the transverse section, where m_t x_t = m_n x.
    pub fn gear_shape(&self, gear: &Gear) -> GearShape {
        let cosine = self.helix_cosine();
        GearShape {
            teeth: gear.teeth.into(),
            profile_shift: gear.profile_shift * cosine,
            addendum: self.addendum_of(gear) * cosine,
            tip_diameter: gear.tip_diameter,
            dedendum: self.dedendum_of(gear) * cosine,
            root_diameter: gear.root_diameter,
            tip_chamfer: gear.tip_chamfer,
            tip_radius: gear.tip_radius,
        }
    }

    /// Shape of the pair in the transverse section. The method `paper` has only sharp tips.
    pub fn shape(&self) -> PairShape {
        let shape = |gear: &Gear| {
            let shape = self.gear_shape(gear);
            let tip_radius = shape.tip_radius.filter(|_| self.method != Method::Paper);
            GearShape { tip_radius, ..shape }
        };
        PairShape {
            module: self.transverse_module(),
            pressure_angle: self.transverse_pressure_angle(),
            centre_distance: self.centre_distance,
            driver: shape(&self.driver),
            driven: shape(&self.driven),
        }
    }

    /// Bore radii of driver and driven gear, in m.
    pub fn bores(&self) -> [f64; 2] {
        [self.driver.bore_radius, self.driven.bore_radius]
    }
}

/// Circles of one gear, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circles<T = f64> {
    /// Reference radius r = m z/2.
    pub reference: T,
    /// Base radius r_b = r cos α.
    pub base: T,
    /// Active tip radius r_a after the chamfer.
    pub tip: T,
    /// Radius of curvature of the involute at its end, L_f: √(r_a² − r_b²) at a sharp tip.
    pub tip_curvature: T,
    /// Radius r_e of the rounding of the tip's edge; 0 for a sharp tip.
    pub edge: T,
    /// Root radius r_f = r + m (x − h_fP*).
    pub root: T,
}

/// Circles of one gear, cut by a rack of a module in m and a pressure angle in rad.
///
/// # Errors
/// [`Refusal::PointedRack`], [`Refusal::TipInsideBase`], and for the rounding of the tip
/// [`Refusal::RoundingInsideBase`] and [`Refusal::RoundingTooWide`]. Each names the field of the
/// driver.
pub fn circles<T: Real>(
    module: f64,
    pressure_angle: f64,
    gear: &GearShape,
) -> Result<Circles<T>, Refusal> {
    let (module, alpha): (T, T) = (module.into(), pressure_angle.into());
    let (half, two): (T, T) = (0.5.into(), 2.0.into());
    let shift: T = gear.profile_shift.into();
    let reference = module * gear.teeth.into() * half;
    let base = reference * alpha.sine_cosine().1;
    let above_reference = |diameter: f64| <T as From<f64>>::from(diameter) * half - reference;
    let height =
        gear.tip_diameter.map_or_else(|| module * (shift + gear.addendum.into()), above_reference)
            - gear.tip_chamfer.into();
    let half_sine = (alpha * half).sine_cosine().0;
    let most_dedendum = std::f64::consts::FRAC_PI_4 / pressure_angle.tan();
    if gear.dedendum >= most_dedendum {
        return Err(Refusal::PointedRack {
            gear: GearSide::Driver,
            dedendum: gear.dedendum,
            limit: most_dedendum,
        });
    }
    let over_base = two * reference * half_sine * half_sine + height;
    if over_base <= T::zero() {
        let is_cut = over_base + gear.tip_chamfer.into() > T::zero();
        return Err(Refusal::TipInsideBase {
            gear: GearSide::Driver,
            is_cut,
            tip: (reference + height).rounded(),
            base: base.rounded(),
        });
    }
    let tip = reference + height;
    let edge: T = gear.tip_radius.unwrap_or(0.0).into();
    let centre_over_base = over_base - edge;
    if centre_over_base <= T::zero() {
        return Err(Refusal::RoundingInsideBase {
            gear: GearSide::Driver,
            radius: edge.rounded(),
            limit: over_base.rounded(),
        });
    }
    let centre_curvature = (centre_over_base * (tip - edge + base)).root();
    if edge > T::zero() {
        check_room(pressure_angle, gear, [base, centre_curvature, edge].map(Real::rounded))?;
    }
    Ok(Circles {
        reference,
        base,
        tip,
        tip_curvature: centre_curvature + edge,
        edge,
        root: reference
            + gear
                .root_diameter
                .map_or_else(|| module * (shift - gear.dedendum.into()), above_reference),
    })
}

/// Refuses a rounding that is too large for the tooth: its arc would begin beyond the centre line
/// of the tooth.
///
/// # Formula
/// ```text
/// (π/2 + 2 x tan α)/z + inv α − inv acos(rb/rC) − re/rb >= 0
/// ```
fn check_room(
    pressure_angle: f64,
    gear: &GearShape,
    [base, centre_curvature, radius]: [f64; 3],
) -> Result<(), Refusal> {
    let tangent = pressure_angle.tan();
    let half_angle =
        (std::f64::consts::FRAC_PI_2 + 2.0 * gear.profile_shift * tangent) / gear.teeth + tangent
            - pressure_angle;
    let roll = centre_curvature / base;
    let room = half_angle - (roll - roll.atan()) - radius / base;
    if room < 0.0 {
        return Err(Refusal::RoundingTooWide {
            gear: GearSide::Driver,
            radius,
            lack: -room * base,
        });
    }
    Ok(())
}

impl<T: Real> Circles<T> {
    pub(super) fn rounded(self) -> Circles {
        Circles {
            reference: self.reference.rounded(),
            base: self.base.rounded(),
            tip: self.tip.rounded(),
            tip_curvature: self.tip_curvature.rounded(),
            edge: self.edge.rounded(),
            root: self.root.rounded(),
        }
    }
}

impl Circles {
    /// The circles of the gear with a sharp tip.
    pub fn sharp(&self) -> Circles {
        if self.edge <= 0.0 {
            return *self;
        }
        Circles { tip_curvature: self.curvature_at(self.tip), edge: 0.0, ..*self }
    }

    /// Radius of curvature of the involute at a radius, √(radius² − r_b²), in m.
    pub(super) fn curvature_at(&self, radius: f64) -> f64 {
        ((radius - self.base) * (radius + self.base)).max(0.0).sqrt()
    }

    /// Radius at which the involute ends, in m: the tip radius for a sharp tip.
    pub fn involute_end(&self) -> f64 {
        if self.edge <= 0.0 { self.tip } else { self.base.hypot(self.tip_curvature) }
    }
}

/// The removed parts of the path of contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipLosses {
    /// The sum of the removed parts, in m.
    pub total: f64,
    /// The tip chamfer or tip radius that removes the greatest part; `None` for whole tips.
    pub greatest: Option<Member>,
}

/// The removed parts of the path of contact of a pair, with the circles of driver and driven gear.
fn tip_losses(shape: &PairShape, driver: &Circles, driven: &Circles) -> TipLosses {
    let [driver_chamfer, driver_radius] = losses(&shape.driver, driver);
    let [driven_chamfer, driven_radius] = losses(&shape.driven, driven);
    let all = [
        (driver_chamfer, (Some(GearSide::Driver), "tip_chamfer")),
        (driver_radius, (Some(GearSide::Driver), "tip_radius")),
        (driven_chamfer, (Some(GearSide::Driven), "tip_chamfer")),
        (driven_radius, (Some(GearSide::Driven), "tip_radius")),
    ];
    let greatest = all.iter().max_by(|one, other| one.0.total_cmp(&other.0));
    TipLosses {
        total: all.iter().map(|(loss, _)| loss).sum(),
        greatest: greatest.filter(|(loss, _)| *loss > 0.0).map(|(_, cut)| *cut),
    }
}

/// The parts that the chamfer and the rounding of one gear remove, in m.
fn losses(gear: &GearShape, circles: &Circles) -> [f64; 2] {
    let [whole, chamfered] =
        [circles.tip + gear.tip_chamfer, circles.tip].map(|radius| circles.curvature_at(radius));
    [whole - chamfered, chamfered - circles.tip_curvature].map(|loss| loss.max(0.0))
}

/// Mesh force F₀ = T₁/r_b1, in N.
pub fn mesh_force(torque: f64, geometry: &Geometry) -> f64 {
    torque / geometry.driver.base
}
