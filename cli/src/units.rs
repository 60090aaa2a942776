//! Units. The law holds in every consistent set of them, so they are names, and only pictures convert.

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
    Length,
    Force,
    /// Also moduli.
    Pressure,
    /// Also the damage parameter.
    Stiffness,
    StiffnessSlope,
    Energy,
}

impl Units {
    pub fn unit(self, quantity: Quantity) -> &'static str {
        match (quantity, self) {
            (Quantity::Number, _) => "-",
            (Quantity::Length, Units::Si) => "m",
            (Quantity::Length, Units::Mm) => "mm",
            (Quantity::Force, _) => "N",
            (Quantity::Pressure, Units::Si) => "Pa",
            (Quantity::Pressure, Units::Mm) => "MPa",
            (Quantity::Stiffness, Units::Si) => "N/m",
            (Quantity::Stiffness, Units::Mm) => "N/mm",
            (Quantity::StiffnessSlope, Units::Si) => "N/m^2",
            (Quantity::StiffnessSlope, Units::Mm) => "N/mm^2",
            (Quantity::Energy, Units::Si) => "J",
            (Quantity::Energy, Units::Mm) => "mJ",
        }
    }

    /// This unit in SI units.
    pub fn in_si(self, quantity: Quantity) -> f64 {
        match (quantity, self) {
            (_, Units::Si) | (Quantity::Number | Quantity::Force, _) => 1.0,
            (Quantity::Length | Quantity::Energy, Units::Mm) => 1e-3,
            (Quantity::Pressure | Quantity::StiffnessSlope, Units::Mm) => 1e6,
            (Quantity::Stiffness, Units::Mm) => 1e3,
        }
    }
}
