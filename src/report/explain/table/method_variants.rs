//! What is said of a quantity, or taken for granted, otherwise in some methods and cases.

use crate::model::Inputs;
use crate::model::inputs::Method;

/// What takes the place of an explanation's words in the cases that the condition names.
#[derive(Debug)]
pub(in crate::report::explain) struct Otherwise {
    pub(in crate::report::explain) key: &'static str,
    when: fn(&Inputs) -> bool,
    /// What it is and what it is good for.
    pub(in crate::report::explain) says: &'static str,
    /// What is taken for granted; empty where that stays.
    pub(in crate::report::explain) assumes: &'static str,
}

/// The first that fits is told.
pub(in crate::report::explain) static TABLE: &[Otherwise] = &[
    Otherwise {
        key: "mesh_force",
        when: |inputs| inputs.deflection_taken().is_some(),
        says: "The steady force along the line of action: the yardstick of the impact force. It does not deflect the teeth here: \
            the case gives the deflection, and so the load changes neither where nor how hard the tooth strikes.",
        assumes: "",
    },
    Otherwise {
        key: "equivalent_error",
        when: by_sharing,
        says: "What the gears' own deviations bring the incoming tooth in early, along the line of action, without the reliefs: \
            in this method they act on the flanks, as far as they reach. What method exact calls Δf is this and e_m.",
        assumes: "f_pb of both gears and j_bn are independent random deviations, which add as squares: 1/√2 stands for that. \
            The reliefs are no part of it.",
    },
    Otherwise {
        key: "equivalent_error",
        when: by_print,
        says: "What the gears' own deviations bring the incoming tooth in early, along the line of action. Relief counts \
            against it by 1/√2, as printed.",
        assumes: "f_pb of both gears, j_bn and e_m are independent random deviations, which add as squares: 1/√2 stands for that. \
            A relief that was ground is none: method exact counts it in full.",
    },
    Otherwise {
        key: "modification",
        when: by_sharing,
        says: "What the reliefs take off where tip and root meet: the driven gear's tip relief and the driver's root relief, \
            below 0. It counts in Δ alone; the forces of this method take the reliefs from the flanks, by length and shape.",
        assumes: "Both reliefs are there in full where the driven tip meets the driver's flank.",
    },
    Otherwise {
        key: "modification",
        when: by_print,
        says: "What the reliefs take off where tip and root meet: the driven gear's tip relief and the driver's root relief, \
            below 0. As printed, Δf counts it by 1/√2.",
        assumes: "",
    },
    Otherwise {
        key: "combined_deflection",
        when: |inputs| inputs.method == Method::Dynamic,
        says: "How far the pairs that carry the load give way along the line of action at rest, while the incoming pair stands at \
            E; in motion the mesh swings about that. A deflection that the case gives is left aside.",
        assumes: "",
    },
    Otherwise {
        key: "combined_deflection",
        when: by_sharing,
        says: "How far the pairs that carry the load give way along the line of action while the incoming pair stands at E, all \
            on flanks without relief. A deflection that the case gives is left aside.",
        assumes: "",
    },
    Otherwise {
        key: "total_deviation",
        when: |inputs| inputs.method == Method::Dynamic,
        says: "What would bring the tooth in early at rest, in all. Above 0 the load would press it on before E; in motion the mesh \
            swings, and it may touch or not, whatever the sign: dynamic_first_contact_angle tells.",
        assumes: "Deviations and deflection add up along the line of action, the gears at rest, the pairs ahead on flanks without \
            relief.",
    },
    Otherwise {
        key: "total_deviation",
        when: by_sharing,
        says: "What brings the tooth in early, in all: above 0 it touches before E, at 0 or below it comes in on time, where the \
            pairs ahead stand on flanks without relief. The balance of all pairs decides: static_first_contact_angle tells.",
        assumes: "Deviations and deflection add up along the line of action, the pairs ahead on flanks without relief.",
    },
    Otherwise {
        key: "total_deviation",
        when: by_print,
        says: "What brings the tooth in early, in all. At 0 or below it comes in on time, and there is no corner contact; above 0 \
            the tip strikes where the printed equations find an angle before E, too.",
        assumes: "",
    },
    Otherwise {
        key: "combined_deflection",
        when: |inputs| inputs.deflection_taken().is_some(),
        says: "How far the pairs that carry the load give way along the line of action while the incoming pair stands at E: as the \
            case gives it, whatever the load.",
        assumes: "The given value is that of this load; nothing here holds the two against each other.",
    },
    Otherwise {
        key: "approach_angle_driver",
        when: by_print,
        says: "How far the driver has still to turn from D to E by the printed equations, which are linear in Δ. They put D so close \
            to E that the tip has hardly begun to close its gap: see closed_gap.",
        assumes: "",
    },
    Otherwise {
        key: "approach_angle_driven",
        when: by_print,
        says: "How far the driven gear has still to turn from D to E by the printed equations, which are linear in Δ. They put D so \
            close to E that the tip has hardly begun to close its gap: see closed_gap.",
        assumes: "",
    },
    Otherwise {
        key: "impact_duration",
        when: by_print,
        says: "How long the impact lasts: by Eq. 32 as it stands in print.",
        assumes: "Two spheres striking: the teeth's bending, which makes the force, has no part in it.",
    },
    Otherwise {
        key: "friction_ratio",
        when: by_print,
        says: "The paper's averaged impact friction coefficient: change of the sliding velocity over change of the approach \
            velocity from D to D', where the impact ends. D' is the tip where the triangle of Eq. 34 closes, after the turn of T_S,32.",
        assumes: "",
    },
    Otherwise {
        key: "static_peak_force",
        when: |inputs| inputs.friction_coefficient.is_some(),
        says: "The most that the incoming tooth carries at rest on its whole way; in single contact all of the mesh force, and what \
            friction adds to it.",
        assumes: "",
    },
    Otherwise {
        key: "impact_force_low",
        when: by_sharing,
        says: LOWEST,
        assumes: BAND,
    },
    Otherwise {
        key: "impact_force_high",
        when: by_sharing,
        says: HIGHEST,
        assumes: BAND,
    },
];

const LOWEST: &str = "The force of the free impact by the most compliant of the stiffness models that cover the pair.";
const HIGHEST: &str =
    "The force of the free impact by the stiffest of the stiffness models that cover the pair.";
const BAND: &str = "The models in range are the beam, and the fit of Kuang and Yang where it covers the pair, each with three contact \
    formulas and its own deflection. They share the mass, so that the band says less than the 10 % that is honest.";

/// The words that hold in a case with these inputs, where they are others than the table's.
pub(in crate::report::explain) fn of(key: &str, inputs: &Inputs) -> Option<&'static Otherwise> {
    TABLE
        .iter()
        .find(|otherwise| otherwise.key == key && (otherwise.when)(inputs))
}

fn by_sharing(inputs: &Inputs) -> bool {
    inputs.method.shares_load()
}

fn by_print(inputs: &Inputs) -> bool {
    inputs.method == Method::Paper
}

#[cfg(test)]
mod tests {
    use super::TABLE;
    use crate::model::Quantity;

    #[test]
    fn every_key_is_a_quantity() {
        assert!(
            TABLE
                .iter()
                .all(|otherwise| Quantity::find(otherwise.key).is_some())
        );
    }
}
