//! Explanations of the pair's geometry, its load and its masses.

use super::Explanation;
use crate::report::explain::context::Formula::{By, Given, Solved, Text};
use crate::report::explain::valid::pair;

const SPUR_PAIR: &str =
    "External spur gears with involute flanks down to the contact, aligned, on rigid shafts.";

pub(super) static TABLE: &[Explanation] = &[
    Explanation {
        key: "contact_ratio",
        says: "How many pairs are in contact on average: the path of contact E to B, in base pitches, tip chamfers off.",
        formula: Text("(N1B - N1E)/p_b"),
        source: "ISO 21771:2007, transverse contact ratio; Zhou & Chen 2014 print 1.5568 in Table 1.",
        mended: &["Eqs. 16, 20"],
        assumes: SPUR_PAIR,
        valid: &[pair::start, pair::end, pair::contact_ratio],
    },
    Explanation {
        key: "base_pitch",
        says: "Distance from flank to flank along the line of action: what the two gears must have in common to mesh evenly.",
        formula: Text("π m cos α"),
        source: "ISO 21771:2007, base pitch.",
        mended: &[],
        assumes: SPUR_PAIR,
        valid: &[],
    },
    Explanation {
        key: "centre_distance",
        says: "Distance of the axes: as given, else the one at which the profile shifts mesh without backlash.",
        formula: By(|k| match k.inputs.centre_distance {
            Some(_) => Given("pair.centre_distance"),
            None => Text("(r_b1 + r_b2)/cos α_w"),
        }),
        source: "ISO 21771:2007, working centre distance. Zhou & Chen 2014 take r_1 + r_2, which holds without profile shift.",
        mended: &[],
        assumes: SPUR_PAIR,
        valid: &[pair::distance],
    },
    Explanation {
        key: "working_pressure_angle",
        says: "Angle between the line of action and the common tangent of the pitch circles at this centre distance.",
        formula: By(|k| match k.inputs.centre_distance {
            Some(_) => Text("acos((r_b1 + r_b2)/a)"),
            None => Solved {
                equation: "inv α_w = inv α + 2 (x1 + x2) tan α/(z1 + z2), inv t = tan t - t",
                left: "inv α_w",
                right: "inv α + 2 (x1 + x2) tan α/(z1 + z2)",
                unit: "1",
            },
        }),
        source: "ISO 21771:2007, working pressure angle. Zhou & Chen 2014 take α, which holds without profile shift.",
        mended: &[],
        assumes: SPUR_PAIR,
        valid: &[pair::distance],
    },
    Explanation {
        key: "mesh_force",
        says: "The steady force along the line of action: the yardstick of the impact force, and the load that deflects the teeth.",
        formula: Text("T1/r_b1"),
        source: "Statics of the driver, torque over base radius, T1/rb1.",
        mended: &["section 6"],
        assumes: "Constant torque and speed; losses in the mesh left out.",
        valid: &[],
    },
    Explanation {
        key: "reduced_mass",
        says: "Both gears seen as masses on the line of action, in series. Eqs. 31 and 32 use it; the impact force has the \
            effective mass at D instead.",
        formula: Text("m_1 m_2/(m_1 + m_2)"),
        source: "Zhou & Chen 2014, Eqs. 33, 46 and 47.",
        mended: &["Eq. 33, Eq. 50", "Eq. 46", "Eq. 47"],
        assumes: "Each gear is a solid disc of its own width from the bore to the base circle, without web, shaft or coupling: \
            what is fixed to a gear adds to its mass.",
        valid: &[pair::discs],
    },
];
