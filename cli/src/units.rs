//! Units. The friction law holds in any consistent set of units: only pictures convert.

use clap::ValueEnum;
use serde::Deserialize;

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Units {
    /// m, N, Pa, N/m, J
    Si,
    /// mm, N, MPa, N/mm, mJ
    Mm,
}

#[derive(Debug, Clone, Copy)]
pub enum Quantity {
    Number,
    Angle,
    Length,
    Force,
    /// Pressures and moduli.
    Pressure,
    /// Stiffness, and the damage parameter.
    Stiffness,
    StiffnessSlope,
    Energy,
}

impl Units {
    /// The unit of a quantity, and its value in SI units.
    fn unit_and_factor(self, quantity: Quantity) -> (&'static str, f64) {
        let (si, mm, factor) = match quantity {
            Quantity::Number => ("-", "-", 1.0),
            Quantity::Angle => ("deg", "deg", 1.0),
            Quantity::Length => ("m", "mm", 1e-3),
            Quantity::Force => ("N", "N", 1.0),
            Quantity::Pressure => ("Pa", "MPa", 1e6),
            Quantity::Stiffness => ("N/m", "N/mm", 1e3),
            Quantity::StiffnessSlope => ("N/m^2", "N/mm^2", 1e6),
            Quantity::Energy => ("J", "mJ", 1e-3),
        };
        if self == Units::Si { (si, 1.0) } else { (mm, factor) }
    }

    pub fn unit(self, quantity: Quantity) -> &'static str {
        self.unit_and_factor(quantity).0
    }

    pub fn in_si(self, quantity: Quantity) -> f64 {
        self.unit_and_factor(quantity).1
    }
}
