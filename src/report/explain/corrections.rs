//! What is wrong in print in Zhou & Chen 2014, and what is used in its place.

/// An error in print.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Correction {
    /// The equation, or the place.
    pub equation: &'static str,
    /// What is wrong with it.
    pub wrong: &'static str,
    /// What is used.
    pub used: &'static str,
}

const fn mend(equation: &'static str, wrong: &'static str, used: &'static str) -> Correction {
    Correction {
        equation,
        wrong,
        used,
    }
}

/// Every error that a quantity rests on.
#[rustfmt::skip]
pub static MENDS: &[Correction] = &[
    mend("Eq. 1", "scales the modification e_m by 1/√2 with the random pitch errors, as if a ground relief were random",
        "method paper keeps it; the others count e_m in full"),
    mend("Eqs. 7-20", "differences of arctangents, linear in Δ, which put D next to E: the tip has then closed almost nothing of Δ",
        "method paper keeps them; the others solve S(u) = Δ"),
    mend("Eq. 14", "arctan(r_b1/(N1E - Δf)) jumps by π where Δf > N1E", "the difference of Eq. 15 as one atan2, likewise Eqs. 17-19"),
    mend("Eqs. 16, 20", "reach N1E through a rounded contact ratio, 0.6 um off for Table 1", "N1E = a sin α_w - √(r_a2² - r_b2²)"),
    mend("Eq. 22", "labelled ΔV_Dr", "it is ΔV_Dτ"),
    mend("Eqs. 27, 42, 60", "law of cosines, set as a root times a root: the approach velocity at E would be 1.32 m/s for Table 1, not 0",
        "the law of cosines"),
    mend("Eq. 31", "adds an impulse along V_D2 and divides kg/m where kg is meant", "as printed, with m_red in kg"),
    mend("Eq. 32", "Hertz's prefactor 4.53398 is lost; m_red is per width", "as printed with m_red in kg, and beside it with the prefactor and \
        by the model's own spring, which method exact takes"),
    mend("Eq. 33, Eq. 50", "two reduced masses, with r_b2 and with r_b2'", "T_S,32 has that of Eq. 33, F_S that of Eq. 50"),
    mend("Eq. 34", "the angle at O1 in its triangle is not Δθ", "method paper keeps it; exact takes the driven tip at u - ω_2 T_S,32, not past E"),
    mend("Eq. 36", "the arc stands for the chord", "the chord"),
    mend("Eqs. 44, 45", "V_D'n and V_Dn are not defined", "the changes of ΔV_n and ΔV_τ between D and D'"),
    mend("Eq. 46", "J/(b r_b²) is a mass per width", "J/r_b² in kg; energies are of the whole width"),
    mend("Eq. 47", "divides by 2 g", "J = π ρ b/2 (r_b⁴ - r_h⁴)"),
    mend("Eq. 53", "δ_s = F_S/(b q_s) is inverted", "δ_s = F_S q_s/b, with which Eq. 57 holds"),
    mend("Eq. 54", "speaks of the teeth 1-2", "the pair in contact at D is 3-4"),
    mend("Eq. 55", "leaves a undefined", "Hertz's half-width under F_S, solved together with F_S; 1/E' = Σ (1 - ν²)/E"),
    mend("Eq. 56", "is a cubic in z, and explodes outside of its range", "refused outside z 12..100, |x| <= 0.6; the beam serves there"),
    mend("Eq. 64", "is 0/0 without contact, and no Coulomb coefficient bounds it", "no value without contact; the case's μ and stick_limit beside it"),
    mend("Table 1", "prints no face width, and a radius of 20 mm as d0", "the face width is the case's; 20 mm is the bore's radius"),
    mend("section 6", "F_0 = 1260.8 N and f = 0.1811 follow from no sound reading of Table 1", "F_0 = T1/r_b1, 1524.3 N there; f by Eq. 64"),
];

/// The error of that name.
pub(super) fn find(equation: &str) -> Option<&'static Correction> {
    MENDS.iter().find(|mend| mend.equation == equation)
}
