//! Rows of the face width: helical geometry, and the line load of a pair in slices.

use super::{Need, PLAIN, Quantity, checks};
use crate::model::Solution;
use crate::model::Stage::{Geometry, Load, Static, StaticSpectrum};
use crate::model::explanation::Check;
use crate::model::explanation::Formula::{Found, Text};
use crate::model::helix::Helix;
use crate::model::slices::load::{FaceCycle, FaceLoad, LinePeak};

const HELICAL: &str = "External helical gears on parallel, rigid shafts, with involute flanks down to \
    the contact.";
const SLICES: &str = "Each plane across the axis is a spur pair in another phase and with another gap. \
    Its compliance is that of the virtual spur gear of the normal section over cos β_b. A force on a \
    slice displaces the slices beside it over the coupling length. Shafts and bearings do not bend: \
    their tilting is given as misalignment.";
const BALANCE: &str = "Balance ΣF = F0 of the line load in slices with gaps: the model of this program. Decay \
    along the tooth and ends by own finite elements in three dimensions.";
const CHECKS: &[Check] = &[checks::teeth];

/// A row of the helical geometry.
const HELIX: Quantity = Quantity {
    unit: "1",
    shown: "1",
    digits: 5,
    equation: "ISO 21771",
    stage: Geometry,
    source: "ISO 21771:2007.",
    assumptions: HELICAL,
    needs: Need::Slices,
    ..PLAIN
};

/// A result over the face width at rest.
const AT_REST: Quantity = Quantity {
    unit: "m",
    shown: "mm",
    digits: 4,
    equation: "ΣF = F0",
    stage: Static,
    source: BALANCE,
    formula: LOAD,
    assumptions: SLICES,
    checks: CHECKS,
    needs: Need::Slices,
    ..PLAIN
};

const LOAD: super::Formula =
    Found("line load of the balance ∫ Σ p dz = F_0 in slices, x - gap = displacement", &["F_0"]);

/// A line load.
const LINE_LOAD: Quantity = Quantity { unit: "N/m", shown: "N/mm", digits: 5, ..AT_REST };

fn helix(solution: &Solution) -> Option<&Helix> {
    solution.helix.as_ref()
}

fn load(solution: &Solution) -> Option<&FaceLoad> {
    solution.face_load.as_deref()
}

fn cycle(solution: &Solution) -> Option<&FaceCycle> {
    solution.face_cycle.as_ref()
}

fn line_load(peak: LinePeak) -> f64 {
    peak.line_load
}

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "transverse_module",
        symbol: "m_t",
        label: "transverse module",
        unit: "m",
        shown: "mm",
        value: |s| Some(helix(s)?.transverse_module),
        meaning: "The module in the plane across the axis; the case gives that of the normal section.",
        formula: Text("m/cos β"),
        ..HELIX
    },
    Quantity {
        key: "transverse_pressure_angle",
        symbol: "α_t",
        label: "transverse pressure angle",
        unit: "rad",
        shown: "deg",
        value: |s| Some(helix(s)?.transverse_pressure_angle),
        meaning: "The pressure angle in the plane across the axis; the case gives that of the normal \
            section.",
        formula: Text("atan(tan α/cos β)"),
        ..HELIX
    },
    Quantity {
        key: "base_helix_angle",
        symbol: "β_b",
        label: "base helix angle",
        unit: "rad",
        shown: "deg",
        value: |s| Some(helix(s)?.base_helix_angle),
        meaning: "The helix angle at the base cylinder: the angle of the contact lines on the plane of \
            action.",
        formula: Text("asin(sin β cos α)"),
        ..HELIX
    },
    Quantity {
        key: "virtual_teeth_driver",
        symbol: "z_n1",
        label: "virtual teeth of the driver",
        value: |s| Some(helix(s)?.virtual_teeth[0]),
        meaning: "The number of teeth of the spur gear with the curvature of the normal section; \
            rounded, the gear whose compliance the driver has.",
        formula: Text("z1/(cos² β_b cos β)"),
        ..HELIX
    },
    Quantity {
        key: "virtual_teeth_driven",
        symbol: "z_n2",
        label: "virtual teeth of the driven gear",
        value: |s| Some(helix(s)?.virtual_teeth[1]),
        meaning: "The number of teeth of the spur gear with the curvature of the normal section; \
            rounded, the gear whose compliance the driven gear has.",
        formula: Text("z2/(cos² β_b cos β)"),
        ..HELIX
    },
    Quantity {
        key: "axial_pitch",
        symbol: "p_x",
        label: "axial pitch",
        unit: "m",
        shown: "mm",
        value: |s| Some(helix(s)?.axial_pitch),
        meaning: "The distance of neighbouring flanks along the axis.",
        formula: Text("π m/sin β"),
        ..HELIX
    },
    Quantity {
        key: "overlap_ratio",
        symbol: "ε_β",
        label: "overlap ratio",
        value: |s| Some(helix(s)?.overlap_ratio),
        meaning: "The base pitches by which one end of the face is ahead of the other.",
        formula: Text("b tan β_b/p_b"),
        ..HELIX
    },
    Quantity {
        key: "total_contact_ratio",
        symbol: "ε_γ",
        label: "total contact ratio",
        value: |s| Some(s.geometry.contact_ratio + helix(s)?.overlap_ratio),
        meaning: "The mean number of tooth pairs with a contact line on the face.",
        formula: Text("ε + ε_β"),
        ..HELIX
    },
    Quantity {
        key: "axial_force",
        symbol: "F_ax",
        label: "axial force on the driver",
        unit: "N",
        shown: "N",
        stage: Load,
        value: |s| Some(helix(s)?.axial_force),
        meaning: "The force along the axis on the driver, towards +z above 0; the driver turns \
            positively about +z. The driven gear has the opposite force.",
        formula: Text("F_0 tan β_b"),
        is_signed: true,
        ..HELIX
    },
    Quantity {
        key: "static_first_contact_z",
        symbol: "z_st",
        label: "static: first contact at z",
        value: |s| Some(load(s)?.first.z),
        meaning: "The place of the first contact of the incoming tooth along the axis, from the middle \
            of the common face.",
        is_signed: true,
        ..AT_REST
    },
    Quantity {
        key: "static_first_contact_path",
        symbol: "s_st",
        label: "static: first contact after E",
        value: |s| Some(load(s)?.first.path),
        meaning: "The path after E of the first contact in its own plane across the axis. Below 0 the tip \
            strikes before E.",
        is_signed: true,
        ..AT_REST
    },
    Quantity {
        key: "static_peak_line_load",
        symbol: "w_st,max",
        label: "static: peak line load",
        value: |s| Some(line_load(load(s)?.peak)),
        meaning: "The greatest force per width of the incoming tooth.",
        ..LINE_LOAD
    },
    Quantity {
        key: "static_peak_line_load_z",
        symbol: "z_st,max",
        label: "static: peak line load at z",
        value: |s| Some(load(s)?.peak.place.z),
        meaning: "Where the greatest line load acts, along the axis from the middle of the common face.",
        is_signed: true,
        ..AT_REST
    },
    Quantity {
        key: "static_peak_line_load_before_start",
        symbol: "w_st,DE",
        label: "static: peak line load before E",
        value: |s| load(s)?.before_start.map(line_load),
        meaning: "The greatest force per width of the driven tip before E: that of the corner contact.",
        ..LINE_LOAD
    },
    Quantity {
        key: "static_peak_line_load_after_end",
        symbol: "w_st,B",
        label: "static: peak line load after B",
        value: |s| load(s)?.after_end.map(line_load),
        meaning: "The greatest force per width of the driver's tip after B.",
        ..LINE_LOAD
    },
    Quantity {
        key: "face_load_factor",
        symbol: "K_Hβ",
        label: "face load factor",
        unit: "1",
        shown: "1",
        digits: 5,
        equation: "ISO 6336-1",
        stage: StaticSpectrum,
        value: |s| Some(cycle(s)?.face_load_factor),
        meaning: "The greatest line load of all pairs, averaged over a base pitch without deviations, \
            over its mean over the face.",
        formula: Found(
            "b max w/F_0, w: line load of all pairs averaged over a base pitch",
            &["F_0"],
        ),
        source: "ISO 6336-1:2019, 7.2: greatest over mean load per width; the load by slices.",
        ..AT_REST
    },
    Quantity {
        key: "load_swing",
        symbol: "Δz",
        label: "swing of the load",
        equation: "∫ z Σp dz/F0",
        stage: StaticSpectrum,
        value: |s| Some(cycle(s)?.swing),
        meaning: "The way along the axis by which the point of attack of the force swings in every base \
            pitch. Times the force it is the shuttling moment on the bearings.",
        formula: Found("max - min over a base pitch of ∫ z Σ p dz/F_0", &["F_0"]),
        source: "Mean of z by the line load, ∫ z Σp dz/F0; balance in slices.",
        ..AT_REST
    },
];
