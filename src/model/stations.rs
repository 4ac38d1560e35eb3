//! The force over roll angle, from D to E.

/// A place between D and E at which the impact is computed as if it were D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Driver's angle before E, in rad.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, in rad.
    pub roll_angle_driven: f64,
    /// O₁J, in m.
    pub radius_driver: f64,
    /// Approach velocity, in m/s.
    pub normal_velocity: f64,
    /// Sliding velocity, in m/s.
    pub sliding_velocity: f64,
    /// Impact force, in N.
    pub impact_force: f64,
}
