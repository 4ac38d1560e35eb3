//! The load shared by all pairs in contact without inertia, the harmonics of its transmission error,
//! and the frequencies of the mesh.

#[cfg(test)]
mod tests;

use super::Refusal;
use super::budget::{CURVE_WORK, STATIONS};
use super::mesh::Mesh;
use super::pair_forces::{Balance, Carrying};
use super::stations::{Spacing, Station};
use crate::numeric::root::greatest;
use crate::numeric::{distinct, quadrature, root, steps};
use std::f64::consts::TAU;

/// Samples in a base pitch in the search for the incoming pair.
const SAMPLES: f64 = 16.0;
/// Least number of samples between two borders of the mesh.
const LEAST_SAMPLES: f64 = 2.0;

/// Load of the incoming tooth from its first to its last contact.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StaticLoad {
    /// Driven gear's angle before E at the first contact, in rad. `None` without contact before E.
    pub first_contact_angle: Option<f64>,
    /// Driver's angle after B at the last contact, in rad. `None` without contact after B.
    pub last_contact_angle: Option<f64>,
    /// Force of the incoming tooth at E, in N.
    pub force_at_start: f64,
    /// Force of the incoming tooth at B, in N.
    pub force_at_end: f64,
    /// Greatest force of the incoming tooth from its first contact to E, in N. With a root relief it can
    /// be far before E.
    pub approach_force: f64,
    /// Greatest force of the incoming tooth from B to its last contact, in N.
    pub recess_force: f64,
    /// Greatest force of the incoming tooth, in N.
    pub peak_force: f64,
    /// Difference of the greatest and the least displacement of the driver ahead while the incoming
    /// tooth carries, in m.
    pub transmission_error: f64,
    /// Change of the sum of all forces as the incoming tooth passes the pitch point, in N. `None`
    /// without friction.
    pub pitch_jump: Option<f64>,
    /// From the first contact through E to the last contact.
    pub stations: Vec<Station>,
    /// The reason why the stations are less dense than the curve needs.
    pub rough: Option<Refusal>,
}

/// A place of the incoming pair in m, and a place on the same side of every border of the mesh.
type Place = (f64, f64);

/// The range in which the incoming pair can carry. The sides of its ends are inside of the range.
#[derive(Debug, Clone, Copy)]
struct Contact {
    first: Place,
    last: Place,
}

/// The place `s` from `one` to `other`, on their sides of the borders.
fn between(s: f64, one: Place, other: Place) -> Place {
    (s, s.max(one.1.min(other.1)).min(one.1.max(other.1)))
}

/// The shared load from the first contact of the incoming tooth to its last contact.
///
/// # Formula
/// ```text
/// Σ w_k F_k = F0,   w_k = 1 − μ sgn(ΔVτ) ρ1/rb1
/// x + e_k − S(s_k) = Σ_j Q_kj F_j/b  if F_k > 0,   x + e_k − S(s_k) <= Σ_j Q_kj F_j/b  if F_k = 0
/// ```
/// The weights come from the balance of the driver. Before the pitch point the friction of a pair
/// turns the driver forwards, after the pitch point backwards, so that the forces jump there.
/// Without friction the weights are 1.
///
/// # Source
/// Compliances of Zhou & Chen 2014, Eqs. 53-56; the third kind of impact friction in its
/// introduction is the jump at the pitch point. Balance of parallel springs with gaps: for example
/// Seireg & Houser 1970; with a matrix of compliances: Conry & Seireg 1973.
///
/// # Valid for
/// A speed so low that no pair oscillates; any contact ratio.
///
/// # Errors
/// [`Refusal::BeyondReach`] if the deflection of the pairs exceeds the computed range of the mesh.
pub fn static_load(mesh: &Mesh, spacing: Spacing) -> Result<StaticLoad, Refusal> {
    let gap = near_gap(mesh);
    match load_within((mesh, &mesh.within(gap)), gap, spacing) {
        Err(Refusal::BeyondReach) => load_within((mesh, mesh), f64::INFINITY, spacing),
        found => found,
    }
}

/// A gap that pairs rarely close, in m: a multiple of the deviation and of the displacement without
/// it at two places.
fn near_gap(mesh: &Mesh) -> f64 {
    const TIMES: f64 = 2.0;
    let alike = mesh.without_error();
    let places = [0.0, 0.5 * mesh.base_pitch];
    let displacements = places.map(|s| balance(&alike, s, s).displacement);
    TIMES * (displacements[0].max(displacements[1]) + mesh.error.abs())
}

/// The shared load of the pairs in `mesh`, the part of the whole mesh with gaps up to `gap`, in m.
/// The samples between its ends are those of the whole mesh.
///
/// # Errors
/// [`Refusal::BeyondReach`] if a pair may close a wider gap.
fn load_within(
    (whole, mesh): (&Mesh, &Mesh),
    gap: f64,
    spacing: Spacing,
) -> Result<StaticLoad, Refusal> {
    let ((from, to), (whole_from, whole_to)) = (mesh.ends(), whole.ends());
    let mut places = grid(whole, whole_from, whole_to);
    places.retain(|&(s, _)| from < s && s < to);
    places.insert(0, (from, from));
    places.push((to, to));
    let at = |place: Place| (place, balance(mesh, place.0, place.1));
    let mut balances: Vec<(Place, Balance)> = places.into_iter().map(at).collect();
    let is_beyond = |balance: &Balance| balance.displacement + mesh.error.max(0.0) > gap;
    if balances.iter().any(|(_, balance)| is_beyond(balance)) {
        return Err(Refusal::BeyondReach);
    }
    let Some(contact) = contact(mesh, &balances)? else {
        return Ok(StaticLoad::default());
    };
    let (first, last) = (contact.first.0, contact.last.0);
    balances.retain(|&((s, _), _)| s > first && s < last);
    // The displacement is often greatest where the tooth begins or ends to carry.
    balances.insert(0, at(contact.first));
    balances.push(at(contact.last));
    let balances = with_bends(mesh, &balances);
    let peak_force = peak(mesh, &balances, |balance| balance.force);
    let (stations, rough) = stations(mesh, contact, peak_force, spacing);
    let force_at_start = balance(mesh, 0.0, 0.0).force;
    // On the side of the flank: the tip of a rounded driver has another compliance.
    let aside = 1e-9 * mesh.base_pitch;
    let force_at_end = balance(mesh, mesh.length, mesh.length - aside).force;
    let peak_between = |from: Place, to: Place| {
        let inner = balances.iter().filter(|((s, _), _)| from.0 < *s && *s < to.0).copied();
        let part: Vec<_> = [at(from)].into_iter().chain(inner).chain([at(to)]).collect();
        if from.0 < to.0 { peak(mesh, &part, |balance| balance.force) } else { 0.0 }
    };
    Ok(StaticLoad {
        first_contact_angle: (first < 0.0).then(|| -first / mesh.base_radii.1),
        last_contact_angle: (last > mesh.length).then(|| (last - mesh.length) / mesh.base_radii.0),
        force_at_start,
        force_at_end,
        approach_force: peak_between(contact.first, (0.0, -aside)).max(force_at_start),
        recess_force: peak_between((mesh.length, mesh.length + aside), contact.last)
            .max(force_at_end),
        peak_force,
        transmission_error: peak(mesh, &balances, |balance| balance.displacement)
            + peak(mesh, &balances, |balance| -balance.displacement),
        pitch_jump: pitch_jump(mesh),
        stations,
        rough,
    })
}

/// The balance with the incoming pair at `s`. On a border the sliding direction is that at
/// `inside`.
pub fn balance(mesh: &Mesh, s: f64, inside: f64) -> Balance {
    mesh.pair_set(s, inside).balance(mesh.force)
}

/// How far the displacement by the other pairs exceeds the gap of the incoming pair, in m. Above 0
/// it carries.
fn lead(mesh: &Mesh, s: f64) -> f64 {
    lead_of(mesh, 0, (s, s))
}

/// The same of the pair `ahead`. On a border, the second place selects the side.
fn lead_of(mesh: &Mesh, ahead: i32, (s, inside): Place) -> f64 {
    let lead = mesh.pair_set(s, inside).lead(ahead, mesh.force);
    lead.clamp(-mesh.length, mesh.length)
}

/// Whether a pair still carries at an end of the mesh.
pub(super) fn reaches_ends(mesh: &Mesh) -> bool {
    let (from, to) = mesh.ends();
    lead(mesh, from) > 0.0 || lead(mesh, to) > 0.0
}

/// Samples between the borders and on both sides of each border. Friction jumps at the pitch point,
/// and stiffness where a rounded tip begins to touch.
fn grid(mesh: &Mesh, from: f64, to: f64) -> Vec<Place> {
    /// Of the distance between two borders.
    const BESIDE: f64 = 1e-6;
    let borders = mesh.borders(from, to);
    let between = |ends: &[f64]| {
        let (from, to, length) = (ends[0], ends[1], ends[1] - ends[0]);
        let samples = (SAMPLES * length / mesh.base_pitch).ceil().max(LEAST_SAMPLES) as usize;
        let beside = BESIDE * length;
        (0..=samples).map(move |step| {
            let s = from + length * step as f64 / samples as f64;
            match step {
                0 => (from, from + beside),
                _ if step == samples => (to, to - beside),
                _ => (s, s),
            }
        })
    };
    borders.windows(2).flat_map(between).collect()
}

/// The greatest lead before E, or of the outgoing pair after B, in m: the displacement by the other
/// pairs minus the gap of the pair. Above 0 the tooth touches there. A negative value is the gap
/// that is left.
///
/// # Errors
/// [`Refusal::BeyondReach`] if the deflection of the pairs exceeds the computed range of the mesh.
pub fn lead_at_rest(mesh: &Mesh, at_exit: bool) -> Result<f64, Refusal> {
    let (end, places) = beyond(mesh, at_exit);
    let places = places.into_iter();
    let leads: Vec<_> = places.map(|place| (place.0, lead_of(mesh, 0, place))).collect();
    let is_clear = lead(mesh, end) <= 0.0;
    let found = is_clear.then(|| greatest(&leads, |s| lead(mesh, s)).1);
    found.ok_or(Refusal::BeyondReach)
}

/// Work of [`lead_at_rest`]: the number of places times the pairs at each place.
pub fn lead_work(mesh: &Mesh, at_exit: bool) -> u64 {
    (beyond(mesh, at_exit).1.len() * mesh.standing(0.0).count()) as u64
}

/// The end of the mesh before E, or after B, and places up to there.
fn beyond(mesh: &Mesh, at_exit: bool) -> (f64, Vec<Place>) {
    let (from, to) = mesh.ends();
    if at_exit { (to, grid(mesh, mesh.length, to)) } else { (from, grid(mesh, from, 0.0)) }
}

/// The range from the first to the last contact of the incoming pair. `None` if the pair never
/// carries.
fn contact(mesh: &Mesh, balances: &[(Place, Balance)]) -> Result<Option<Contact>, Refusal> {
    let lead_of = |balance: &Balance| {
        let lead = balance.lead.unwrap_or(f64::INFINITY);
        lead.clamp(-mesh.length, mesh.length)
    };
    let leads = balances.iter().map(|(place, of)| (*place, lead_of(of)));
    let mut leads: Vec<(Place, f64)> = leads.collect();
    let first = first_touch(mesh, &leads)?;
    leads.reverse();
    let ends = first.zip(first_touch(mesh, &leads)?);
    Ok(ends.map(|(first, last)| Contact { first, last }))
}

/// The place at which the incoming pair begins to carry, in the order of the samples. `None` if the
/// pair never carries.
fn first_touch(mesh: &Mesh, leads: &[(Place, f64)]) -> Result<Option<Place>, Refusal> {
    let carrying = leads.iter().position(|&(_, lead)| lead > 0.0);
    let mut apart: Vec<(Place, f64)> = leads[..carrying.unwrap_or(leads.len())].to_vec();
    let mut carries = carrying.map(|first| leads[first].0);
    // A short contact may be between two samples.
    while let Some(hidden) = hidden_contact(mesh, &apart) {
        let from = apart[0].0.0;
        apart.retain(|&((s, _), _)| (s - from).abs() < (hidden - from).abs());
        carries = Some((hidden, hidden));
    }
    let Some(carries) = carries else {
        return Ok(None);
    };
    let &(apart, _) = apart.last().ok_or(Refusal::BeyondReach)?;
    Ok(Some(root_between(mesh, 0, apart, carries)))
}

/// A place between samples at which the incoming pair carries, although it carries at none of them.
fn hidden_contact(mesh: &Mesh, apart: &[(Place, f64)]) -> Option<f64> {
    let mut known: Vec<_> = apart.iter().map(|&((s, _), lead)| (s, lead)).collect();
    known.sort_by(|one, other| one.0.total_cmp(&other.0));
    let (s, lead) = greatest(&known, |s| lead_of(mesh, 0, (s, s)));
    (lead > 0.0).then_some(s)
}

/// The place at which the pair `ahead` begins or stops to carry, between a place where it is apart
/// and a place where it carries, and its side on which the pair carries.
fn root_between(mesh: &Mesh, ahead: i32, apart: Place, carries: Place) -> Place {
    if apart.0.to_bits() == carries.0.to_bits() {
        return carries;
    }
    let root = root::between(apart.0, carries.0, |s| {
        let lead = lead_of(mesh, ahead, between(s, apart, carries));
        // The samples decide whether the pair carries there, whatever the rounding.
        if s.to_bits() == carries.0.to_bits() {
            lead.max(f64::MIN_POSITIVE)
        } else if s.to_bits() == apart.0.to_bits() {
            lead.min(0.0)
        } else {
            lead
        }
    });
    between(root, apart, carries)
}

/// Adds the places where a pair begins or stops to carry, at which all curves have a bend. The ends
/// of the contact of the incoming pair are among the balances.
fn with_bends(mesh: &Mesh, balances: &[(Place, Balance)]) -> Vec<(Place, Balance)> {
    let mut all = Vec::with_capacity(balances.len());
    for (index, (place, here)) in balances.iter().enumerate() {
        if let Some((before, there)) = index.checked_sub(1).map(|before| balances[before]) {
            let is_at_end = index == 1 || index + 1 == balances.len();
            let changes = there.carrying.differences(here.carrying);
            let changes = changes.filter(|&ahead| before.0 < place.0 && !(ahead == 0 && is_at_end));
            let bend = |ahead: i32| {
                if here.carrying.has(ahead) {
                    root_between(mesh, ahead, before, *place)
                } else {
                    root_between(mesh, ahead, *place, before)
                }
            };
            let is_between = |bend: &Place| before.0 < bend.0 && bend.0 < place.0;
            let mut bends: Vec<Place> = changes.map(bend).filter(is_between).collect();
            bends.sort_by(|one, other| one.0.total_cmp(&other.0));
            all.extend(bends.into_iter().map(|(s, side)| ((s, side), balance(mesh, s, side))));
        }
        all.push((*place, *here));
    }
    all
}

/// The greatest value over the contact, of which `balances` has both ends.
fn peak(mesh: &Mesh, balances: &[(Place, Balance)], value: impl Fn(&Balance) -> f64) -> f64 {
    let known: Vec<(f64, f64)> =
        balances.iter().map(|((s, _), balance)| (*s, value(balance))).collect();
    greatest(&known, |s| value(&balance(mesh, s, s))).1
}

/// Sum of all forces just after the incoming pair passes the pitch point, minus the sum just
/// before.
fn pitch_jump(mesh: &Mesh) -> Option<f64> {
    let pitch_point = mesh.pitch_point()?;
    let aside = 1e-9 * mesh.base_pitch;
    let total = |inside: f64| balance(mesh, pitch_point, inside).total;
    (mesh.friction() > 0.0).then(|| total(pitch_point + aside) - total(pitch_point - aside))
}

/// Stations from the first contact to E and from E to the last contact.
fn stations(
    mesh: &Mesh,
    contact: Contact,
    peak: f64,
    spacing: Spacing,
) -> (Vec<Station>, Option<Refusal>) {
    let most = STATIONS.min(CURVE_WORK / mesh.standing(0.0).count().max(1));
    Station::through_start(contact.first.0, contact.last.0, |from, to| {
        spacing.stations(&[from, to], peak, most, |s| {
            let (s, inside) = between(s, contact.first, contact.last);
            let balance = balance(mesh, s, inside);
            (
                balance.force,
                Station::at(mesh, s, balance.force, balance.total, balance.displacement, None),
            )
        })
    })
}

/// Samples between two borders of the mesh to find changes of the pairs in contact.
const LOOKS: usize = 16;

/// Static transmission error and tooth force of equal pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticSpectrum {
    /// The transmission error over a base pitch.
    pub spectrum: Spectrum,
    /// Greatest force of a tooth, in N.
    pub tooth_force: f64,
}

/// The static displacement of the driver over one base pitch, for a mesh without base pitch
/// deviations.
///
/// # Formula
/// ```text
/// x(s) by Σ w_k F_k = F0 with e_k = 0,   s from 0 to pb
/// ```
/// Every border of the mesh and every gain or loss of contact divides the pitch, so that each piece
/// of x is smooth.
///
/// # Source
/// The balance of [`static_load`]. Gregory, Harris & Munro 1963
/// name the transmission error as the cause of whine.
///
/// # Errors
/// [`Refusal::BeyondReach`] if the deflection of the pairs exceeds the computed range of the mesh.
pub fn static_spectrum(mesh: &Mesh) -> Result<StaticSpectrum, Refusal> {
    let mesh = &mesh.without_error();
    if reaches_ends(mesh) {
        return Err(Refusal::BeyondReach);
    }
    let mut fourier = Fourier::new();
    let mut tooth_force = 0.0f64;
    for ends in mesh.borders(0.0, mesh.base_pitch).windows(2) {
        let inside = f64::midpoint(ends[0], ends[1]);
        for piece in pieces(mesh, (ends[0], ends[1]), inside).windows(2) {
            let (from, to) = (piece[0], piece[1]);
            let place = |part: f64| from + part * (to - from);
            let ahead = |s: f64| balance(mesh, s, inside).displacement;
            let pitch = mesh.base_pitch;
            fourier.add((from / pitch, to / pitch), |part| ahead(place(part)));
            for sign in [-1.0, 1.0] {
                fourier.include(sign * peak_between((from, to), |s| sign * ahead(s)));
            }
            let force = |s: f64| {
                let forces = mesh.pair_set(s, inside).shared(mesh.force).1;
                forces.into_iter().fold(0.0, f64::max)
            };
            tooth_force = tooth_force.max(peak_between((from, to), force));
        }
    }
    Ok(StaticSpectrum { spectrum: fourier.spectrum(1), tooth_force })
}

/// The greatest value of a smooth function.
fn peak_between((from, to): (f64, f64), value: impl Fn(f64) -> f64) -> f64 {
    let known: Vec<(f64, f64)> = steps(from, to, 8).map(|s| (s, value(s))).collect();
    greatest(&known, value).1
}

/// The borders of the pieces with the same touching pairs, between two borders of the mesh.
pub(crate) fn pieces(mesh: &Mesh, (from, to): (f64, f64), inside: f64) -> Vec<f64> {
    let places: Vec<(f64, Carrying)> =
        steps(from, to, LOOKS).map(|s| (s, balance(mesh, s, inside).carrying)).collect();
    let mut cuts = vec![from, to];
    for ends in places.windows(2) {
        let [(from, before), (to, after)] = [ends[0], ends[1]];
        let cut = |pair| root::between(from, to, |s| lead_of(mesh, pair, (s, inside)));
        cuts.extend(before.differences(after).map(cut));
    }
    distinct(cuts, 1e-12 * mesh.base_pitch)
}

/// Frequencies of a pair, in Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resonance {
    /// Tooth engagements per second, f_z = z₁ n₁.
    pub mesh_frequency: f64,
    /// Natural frequency f_n of the pair with the mean mesh stiffness.
    pub natural_frequency: f64,
}

impl Resonance {
    /// The frequencies of a mesh at a speed of the driver in rad/s, with the reduced mass in kg.
    ///
    /// # Formula
    /// ```text
    /// f_z = ω1 rb1/pb = z1 ω1/(2 π),   f_n = √(k_m/m_red)/(2 π),   N = f_z/f_n
    /// ```
    ///
    /// # Source
    /// ISO 6336-1:2019, 6.5: N = n1/n_E1, n_E1 = 30 000 √(c_γ/m_red)/(π z1).
    ///
    /// # Valid for
    /// Rigid shafts: one mass on the mesh stiffness.
    pub fn of(speed: f64, mesh: &Mesh, mass: f64) -> Resonance {
        Resonance {
            mesh_frequency: speed * mesh.base_radii.0 / mesh.base_pitch,
            natural_frequency: (mesh.mean_stiffness() / mass).sqrt() / TAU,
        }
    }

    /// N = f_z/f_n.
    pub fn ratio(&self) -> f64 {
        self.mesh_frequency / self.natural_frequency
    }
}

/// Number of harmonics in a spectrum.
pub const HARMONICS: usize = 10;

/// A transmission error over p mesh periods; p = 1 unless the motion repeats after several periods.
/// Amplitudes of the multiples of the mesh frequency, averaged over the periods, without
/// subharmonics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Amplitudes of the harmonics of the mesh frequency from the first, in m.
    pub amplitudes: [f64; HARMONICS],
    /// Difference of the greatest and the least value, in m.
    pub peak_to_peak: f64,
}

/// Partial sums of a Fourier analysis.
///
/// # Formula
/// ```text
/// A_n = 2 |∫ x(τ) exp(−2 π i n τ) dτ|,   τ from 0 to 1 over the period
/// ```
///
/// # Source
/// Fourier series; the integral over each smooth piece by the 12-point Gauss-Legendre rule.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fourier {
    sums: [[f64; 2]; HARMONICS],
    least: f64,
    most: f64,
}

impl Fourier {
    pub(super) fn new() -> Fourier {
        Fourier { sums: [[0.0; 2]; HARMONICS], least: f64::INFINITY, most: f64::NEG_INFINITY }
    }

    /// Adds a smooth piece between two parts of the period. `value` is a function of the part of
    /// the piece, from 0 to 1.
    pub(super) fn add(&mut self, (from, to): (f64, f64), value: impl Fn(f64) -> f64) {
        /// Number of quadrature intervals per period, which resolves the highest harmonic in each
        /// interval.
        const PIECES_OF_PERIOD: f64 = 2.0 * HARMONICS as f64;
        const LEAST: f64 = 3.0;
        let count = ((to - from) * PIECES_OF_PERIOD).ceil().max(LEAST);
        for piece in 0..count as u32 {
            for (node, weight) in quadrature::nodes() {
                let part = (f64::from(piece) + node) / count;
                let height = weight * (to - from) / count * value(part);
                let (sine, cosine) = (TAU * (from + part * (to - from))).sin_cos();
                // Cosine and sine of each order are the last ones turned by the phase.
                let mut turned = [height, 0.0];
                for sum in &mut self.sums {
                    let [x, y] = turned;
                    turned = [x * cosine - y * sine, x * sine + y * cosine];
                    *sum = [sum[0] + turned[0], sum[1] + turned[1]];
                }
            }
        }
    }

    /// Includes a value in the peak-to-peak range.
    pub(super) fn include(&mut self, value: f64) {
        (self.least, self.most) = (self.least.min(value), self.most.max(value));
    }

    /// The spectrum after `periods` periods.
    pub(super) fn spectrum(&self, periods: u32) -> Spectrum {
        let amplitude =
            |[cosine, sine]: [f64; 2]| 2.0 * cosine.hypot(sine) / f64::from(periods.max(1));
        Spectrum { amplitudes: self.sums.map(amplitude), peak_to_peak: self.most - self.least }
    }
}
