//! Units. The friction law holds in any consistent set of units: only pictures convert.

use Quantity::*;
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

#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// Of tables of measured data.
    Time,
}

impl Units {
    /// The unit of a quantity, and its value in SI units.
    fn unit_and_factor(self, quantity: Quantity) -> (&'static str, f64) {
        let (si, mm, factor) = match quantity {
            Number => ("-", "-", 1.0),
            Angle => ("deg", "deg", 1.0),
            Length => ("m", "mm", 1e-3),
            Force => ("N", "N", 1.0),
            Pressure => ("Pa", "MPa", 1e6),
            Stiffness => ("N/m", "N/mm", 1e3),
            StiffnessSlope => ("N/m^2", "N/mm^2", 1e6),
            Energy => ("J", "mJ", 1e-3),
            Time => ("s", "s", 1.0),
        };
        if self == Units::Si { (si, 1.0) } else { (mm, factor) }
    }

    pub fn unit(self, quantity: Quantity) -> &'static str {
        self.unit_and_factor(quantity).0
    }

    pub fn in_si(self, quantity: Quantity) -> f64 {
        self.unit_and_factor(quantity).1
    }

    /// The same units of measured data.
    pub fn of_data(self) -> DataUnits {
        let unit = |quantity| Unit { name: self.unit(quantity), quantity, in_si: self.in_si(quantity) };
        DataUnits { length: unit(Length), force: unit(Force) }
    }
}

impl Quantity {
    /// Its units in tables of measured data.
    pub fn known(self) -> String {
        let names = UNITS.iter().filter(|unit| unit.quantity == self).map(|unit| unit.name);
        names.collect::<Vec<_>>().join(", ")
    }
}

/// A unit of measured data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    pub name: &'static str,
    pub quantity: Quantity,
    pub in_si: f64,
}

const UNITS: [Unit; 10] = {
    const fn of(name: &'static str, quantity: Quantity, in_si: f64) -> Unit {
        Unit { name, quantity, in_si }
    }
    [
        of("m", Length, 1.0),
        of("cm", Length, 1e-2),
        of("mm", Length, 1e-3),
        of("um", Length, 1e-6),
        of("nm", Length, 1e-9),
        of("N", Force, 1.0),
        of("mN", Force, 1e-3),
        of("kN", Force, 1e3),
        of("s", Time, 1.0),
        of("ms", Time, 1e-3),
    ]
};

/// A unit by its symbol or its name: `µm`, `micrometres`, `micron`.
pub fn unit(text: &str) -> Option<Unit> {
    let mut symbol = text.trim().replace(['µ', 'μ'], "u");
    if symbol.len() > 3 {
        let word = symbol
            .to_lowercase()
            .replace("meter", "metre")
            .replace("microns", "micron")
            .replace("micron", "micrometre");
        symbol = word.strip_suffix('s').unwrap_or(&word).to_owned();
        let words = [
            ("micro", "u"),
            ("milli", "m"),
            ("nano", "n"),
            ("centi", "c"),
            ("kilo", "k"),
            ("metre", "m"),
            ("newton", "N"),
            ("second", "s"),
            ("sec", "s"),
        ];
        symbol = words.iter().fold(symbol, |symbol, (word, short)| symbol.replace(word, short));
    }
    // Capitals of spreadsheets: M and N of other units have another meaning.
    let symbol = match symbol.as_str() {
        "MM" | "Mm" => "mm",
        "UM" | "Um" => "um",
        "KN" | "Kn" | "kn" => "kN",
        "sec" | "Sec" => "s",
        symbol => symbol,
    };
    UNITS.into_iter().find(|unit| unit.name == symbol)
}

/// Units of measured displacements and forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataUnits {
    pub length: Unit,
    pub force: Unit,
}

impl DataUnits {
    /// Two units: `um,N`.
    pub fn parse(text: &str) -> Result<DataUnits, String> {
        let (length, force) = text.split_once(',').ok_or("two units are needed, for example um,N")?;
        let find = |text: &str, quantity: Quantity, name: &str| {
            let found = unit(text).filter(|unit| unit.quantity == quantity);
            found.ok_or_else(|| format!("the {name} is in one of {}", quantity.known()))
        };
        Ok(DataUnits { length: find(length, Length, "displacement")?, force: find(force, Force, "force")? })
    }
}
