//! Rows of the face width: helical geometry, and the line load of a pair in slices.

use super::at_rest::ENTRY_RATIO;
use super::conditions::{always, in_slices};
use super::motion::PEAK_RATIO;
use super::{Formula, Need, PLAIN, Quantity, checks};
use crate::model::Solution;
use crate::model::Stage::{Dynamic, Geometry, Load, Static, StaticSpectrum};
use crate::model::explanation::Formula::{Cases, Found, Made, Text, Words};
use crate::model::explanation::{Check, Context, Step, step};
use crate::model::helix::Helix;
use crate::model::inputs::Method;
use crate::model::slices::load::{FaceCycle, FaceLoad};

const HELICAL: &str = "External helical gears on parallel, rigid shafts, with involute flanks \
            down to the contact.";
const SLICES: &str = "Each plane across the axis is a spur pair in another phase and with \
            another gap. Its compliance is that of the virtual spur gear of the normal \
            section over cos β_b. A force on a slice displaces the slices beside it \
            over the coupling length. Shafts and bearings do not bend: their tilting \
            is given as misalignment.";
const BALANCE: &str = "Balance ΣF = F0 of the line load in slices with gaps: the model of this \
            program. Decay along the tooth and ends by own finite elements in three \
            dimensions.";
const CHECKS: &[Check] = &[checks::teeth];

/// A row of the helical geometry.
const HELIX: Quantity = Quantity {
    equation: "ISO 21771",
    stage: Geometry,
    source: "ISO 21771:2007.",
    assumptions: HELICAL,
    needs: Need::Slices,
    ..PLAIN
};

/// A result over the face width at rest.
const AT_REST: Quantity = Quantity {
    equation: "ΣF = F0",
    stage: Static,
    source: BALANCE,
    assumptions: SLICES,
    checks: CHECKS,
    needs: Need::Slices,
    ..PLAIN
};

/// A result over the face width in motion.
const MOVING: Quantity = Quantity {
    equation: "m x'' + ΣF = F0",
    stage: Dynamic,
    source: "The oscillator of Özgüven & Houser 1988 with the line loads in slices: the model of this \
            program. Decay along the tooth and ends by own finite elements in three \
            dimensions.",
    ..AT_REST
};

/// The helical geometry; not by the method of the paper, which has spur pairs alone.
fn helix(solution: &Solution) -> Option<&Helix> {
    (solution.method != Method::Paper).then_some(&solution.helix)
}

/// The load over the face width at rest or in motion.
fn load<const MOVES: bool>(solution: &Solution) -> Option<&FaceLoad> {
    if MOVES { solution.face_motion.as_deref() } else { solution.face_load.as_deref() }
}

/// The peak line load; without slices that of an even load.
fn peak_line_load<const MOVES: bool>(solution: &Solution) -> Option<f64> {
    let even = || {
        let force = if MOVES {
            solution.dynamic.as_ref()?.peak_force
        } else {
            solution.static_load.as_ref()?.peak_force
        };
        Some(force / solution.mesh.as_ref()?.width)
    };
    load::<MOVES>(solution).map(|load| load.peak.line_load).or_else(even)
}

/// The face load factor; without slices that of an even load.
fn face_load_factor(solution: &Solution) -> Option<f64> {
    match &solution.face_cycle {
        Some(cycle) => Some(cycle.peak_line_load / cycle.mean_line_load),
        None => solution.static_spectrum.as_ref()?.is_ok().then_some(1.0),
    }
}

const LOAD: Formula =
    Found("line load of the balance ∫ Σ p dz = F_0 in slices, x - gap = displacement", &["F_0"]);

/// The load over the face width, by the names of the rows.
const fn of_load<const MOVES: bool>(names: &[[&'static str; 3]; 6]) -> [Quantity; 6] {
    const IN_MOTION: Formula =
        Found("line load in motion, x - gap = displacement in slices", &["F_0", "f_n"]);
    const PEAK: Formula = Cases(&[(in_slices, LOAD), (always, Text("F_st,max/b"))]);
    const IN_MOTION_PEAK: Formula = Cases(&[(in_slices, IN_MOTION), (always, Text("F_d,max/b"))]);
    let [first, most, place, before, after, last] = *names;
    let (base, formula) = if MOVES { (MOVING, IN_MOTION) } else { (AT_REST, LOAD) };
    [
        base.row(
            first,
            ("m", "mm", 4),
            |s| Some(load::<MOVES>(s)?.first.z),
            "The place of the first contact of the incoming tooth along the axis, from \
            the middle of the common face. A right-hand driver leads at +z, a left-hand one at -z: at \
            this end its tooth is acute and the driven tooth obtuse.",
            formula,
        )
        .signed(),
        base.row(
            most,
            ("N/m", "N/mm", 5),
            peak_line_load::<MOVES>,
            "The greatest force per width of the incoming tooth.",
            if MOVES { IN_MOTION_PEAK } else { PEAK },
        ),
        base.row(
            place,
            ("m", "mm", 4),
            |s| Some(load::<MOVES>(s)?.peak.place.z),
            "Where the greatest line load acts, along the axis from the middle of the \
            common face.",
            formula,
        )
        .signed(),
        base.row(
            before,
            ("N/m", "N/mm", 5),
            |s| Some(load::<MOVES>(s)?.before_start?.line_load),
            "The greatest force per width of the driven tip before E: that of the \
            corner contact.",
            formula,
        ),
        base.row(
            after,
            ("N/m", "N/mm", 5),
            |s| Some(load::<MOVES>(s)?.after_end?.line_load),
            "The greatest force per width of the driver's tip after B.",
            formula,
        )
        .at_exit(),
        base.row(
            last,
            ("m", "mm", 4),
            |s| Some(load::<MOVES>(s)?.last.z),
            "The place of the last contact of the incoming tooth along the axis, from the middle \
            of the common face.",
            formula,
        )
        .signed(),
    ]
}

const STATIC: [Quantity; 6] = of_load::<false>(&[
    ["static_first_contact_position", "z_st", "static: first contact at z"],
    ["static_peak_line_load", "w_st,max", "static: peak line load"],
    ["static_peak_line_load_position", "z_st,max", "static: peak line load at z"],
    ["static_entry_line_load", "w_st,DE", "static: peak line load before E"],
    ["static_exit_line_load", "w_st,B", "static: peak line load after B"],
    ["static_last_contact_position", "z_st,B", "static: last contact at z"],
]);

const DYNAMIC: [Quantity; 6] = of_load::<true>(&[
    ["dynamic_first_contact_position", "z_dyn", "dynamic: first contact at z"],
    ["dynamic_peak_line_load", "w_dyn,max", "dynamic: peak line load"],
    ["dynamic_peak_line_load_position", "z_dyn,max", "dynamic: peak line load at z"],
    ["dynamic_entry_line_load", "w_dyn,DE", "dynamic: peak line load before E"],
    ["dynamic_exit_line_load", "w_dyn,B", "dynamic: peak line load after B"],
    ["dynamic_last_contact_position", "z_dyn,B", "dynamic: last contact at z"],
]);

fn cycle(solution: &Solution) -> Option<&FaceCycle> {
    solution.face_cycle.as_ref()
}

/// Above 0 for a right-hand driver.
fn axial_force(k: &Context) -> String {
    let sign = if k.inputs.driver_hand.sign() < 0.0 { "-" } else { "" };
    format!("{sign}F_0 tan β_b")
}

pub(super) const STEPS: &[Step] = &[
    step(
        "w_max",
        "greatest line load of all pairs, averaged over a base pitch",
        "N/mm",
        Words("by the balance in slices"),
        |k| Some(cycle(k.solution)?.peak_line_load),
    ),
    step(
        "w_m",
        "mean of this line load over the face",
        "N/mm",
        Words("by the balance in slices"),
        |k| Some(cycle(k.solution)?.mean_line_load),
    ),
];

pub(super) const TABLE: &[Quantity] = &[
    HELIX.row(
        ["transverse_module", "m_t", "transverse module"],
        ("m", "mm", 5),
        |s| Some(helix(s)?.transverse_module),
        "The module in the plane across the axis; the case gives that of the normal \
            section.",
        Text("m/cos β"),
    ),
    HELIX.row(
        ["transverse_pressure_angle", "α_t", "transverse pressure angle"],
        ("rad", "deg", 5),
        |s| Some(helix(s)?.transverse_pressure_angle),
        "The pressure angle in the plane across the axis; the case gives that of \
            the normal section.",
        Text("atan(tan α/cos β)"),
    ),
    HELIX.row(
        ["base_helix_angle", "β_b", "base helix angle"],
        ("rad", "deg", 5),
        |s| Some(helix(s)?.base_helix_angle),
        "The helix angle at the base cylinder: the angle of the contact lines on \
            the plane of action.",
        Text("asin(sin β cos α)"),
    ),
    HELIX.row(
        ["virtual_teeth_driver", "z_n1", "virtual teeth of the driver"],
        ("1", "1", 5),
        |s| Some(helix(s)?.virtual_teeth[0]),
        "The number of teeth of the spur gear with the curvature of the normal \
            section; rounded, the gear whose compliance the driver has.",
        Text("z1/((cos β_b)² cos β)"),
    ),
    HELIX.row(
        ["virtual_teeth_driven", "z_n2", "virtual teeth of the driven gear"],
        ("1", "1", 5),
        |s| Some(helix(s)?.virtual_teeth[1]),
        "The number of teeth of the spur gear with the curvature of the normal \
            section; rounded, the gear whose compliance the driven gear has.",
        Text("z2/((cos β_b)² cos β)"),
    ),
    HELIX.row(
        ["axial_pitch", "p_x", "axial pitch"],
        ("m", "mm", 5),
        |s| Some(helix(s)?.axial_pitch).filter(|pitch| pitch.is_finite()),
        "The distance of neighbouring flanks along the axis.",
        Text("π m/sin β"),
    ),
    HELIX.row(
        ["overlap_ratio", "ε_β", "overlap ratio"],
        ("1", "1", 5),
        |s| Some(helix(s)?.overlap_ratio),
        "The base pitches by which one end of the face is ahead of the other.",
        Text("b tan β_b/p_b"),
    ),
    HELIX.row(
        ["total_contact_ratio", "ε_γ", "total contact ratio"],
        ("1", "1", 5),
        |s| Some(s.geometry.contact_ratio + helix(s)?.overlap_ratio),
        "The mean number of tooth pairs with a contact line on the face.",
        Text("ε + ε_β"),
    ),
    HELIX
        .row(
            ["axial_force", "F_ax", "axial force on the driver"],
            ("N", "N", 5),
            |s| Some(helix(s)?.axial_force),
            "The force along the axis on the driver, towards +z above 0; the driver \
            turns positively about +z. The driven gear has the opposite force.",
            Made(axial_force),
        )
        .stage(Load)
        .signed(),
    STATIC[0],
    AT_REST
        .row(
            ["static_first_contact_path", "s_st", "static: first contact after E"],
            ("m", "mm", 4),
            |s| Some(load::<false>(s)?.first.path),
            "The path after E of the first contact in its own plane across the axis. \
            Below 0 the tip strikes before E.",
            LOAD,
        )
        .signed(),
    STATIC[1],
    STATIC[2],
    STATIC[3],
    STATIC[4],
    STATIC[5],
    DYNAMIC[0],
    DYNAMIC[1],
    DYNAMIC[2],
    DYNAMIC[3],
    DYNAMIC[4],
    DYNAMIC[5],
    AT_REST
        .row(
            ["face_load_factor", "K_Hβ", "face load factor"],
            ("1", "1", 5),
            face_load_factor,
            "The greatest line load of all pairs, averaged over a base pitch without base pitch \
            deviations, over its mean over the face. Misalignment, helix slopes and \
            modifications of the flank lines count.",
            Cases(&[(in_slices, Text("w_max/w_m")), (always, Text("1"))]),
        )
        .equation("ISO 6336-1")
        .stage(StaticSpectrum)
        .source(
            "ISO 6336-1:2019, 7.2: greatest over mean load per width; the load by \
            slices.",
        ),
    AT_REST
        .row(
            ["load_swing", "Δz", "swing of the load"],
            ("m", "mm", 4),
            |s| Some(cycle(s)?.swing),
            "The way along the axis by which the point of attack of the force swings in \
            every base pitch. Times the force it is the shuttling moment on the \
            bearings.",
            Found("max - min over a base pitch of ∫ z Σ p dz/F_0", &["F_0"]),
        )
        .equation("∫ z Σp dz/F0")
        .stage(StaticSpectrum)
        .source("Mean of z by the line load, ∫ z Σp dz/F0; balance in slices."),
    // After the line loads, which are more important.
    ENTRY_RATIO,
    PEAK_RATIO,
];
