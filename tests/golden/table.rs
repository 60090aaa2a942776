//! Reader of the tables of this folder. Of the reference tables inputs are exact doubles, outputs have 25 digits.
#![allow(dead_code, reason = "not every crate uses all of it")]

use microslip::{EllipticParameters, Material, Parameters};
use std::collections::HashMap;
use std::ops::Index;

/// A row by the names of its columns: as numbers (NaN for a cell of text) and as text.
#[derive(Debug)]
pub struct Row {
    text: HashMap<&'static str, &'static str>,
    numbers: HashMap<&'static str, f64>,
}

impl Row {
    pub fn has(&self, name: &str) -> bool {
        self.text.contains_key(name)
    }

    pub fn text(&self, name: &str) -> &'static str {
        self.text[name]
    }
}

impl Index<&str> for Row {
    type Output = f64;
    fn index(&self, name: &str) -> &f64 {
        &self.numbers[name]
    }
}

pub fn table(name: &str) -> Vec<Row> {
    let path = format!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/{}.csv"), name);
    let text: &'static str = std::fs::read_to_string(path).unwrap().leak();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').map(str::trim).collect();
    let row = |line: &'static str| {
        let text: HashMap<_, _> = names.iter().copied().zip(line.split(',').map(str::trim)).collect();
        let numbers = text.iter().map(|(name, value)| (*name, value.parse().unwrap_or(f64::NAN))).collect();
        Row { text, numbers }
    };
    lines.filter(|line| !line.trim().is_empty()).map(row).collect()
}

/// The flat with rounded edges of a row, without load and material.
pub fn geometry(row: &Row) -> Parameters {
    let [flat_half_width, edge_radius, length] = ["a", "R", "L"].map(|name| row[name]);
    let displacement_reference = microslip::parameters::CENTRE_POINT;
    Parameters { flat_half_width, edge_radius, length, displacement_reference, ..Parameters::default() }
}

/// The contact of a row of `contacts`.
pub fn flat(row: &Row) -> Parameters {
    let body = |e: &str, nu: &str| Material { young_modulus: row[e], poisson_ratio: row[nu] };
    Parameters {
        normal_force: row["N"],
        friction_coefficient: row["mu"],
        material: [body("E1", "nu1"), body("E2", "nu2")],
        ..geometry(row)
    }
}

/// The contact of a row of `elliptic`.
pub fn ellipse(row: &Row) -> EllipticParameters {
    EllipticParameters {
        semi_axis_x: row["semi_axis_x"],
        semi_axis_y: row["semi_axis_y"],
        normal_force: row["N"],
        friction_coefficient: row["mu"],
        material: [Material { young_modulus: row["E"], poisson_ratio: row["nu"] }; 2],
        ..EllipticParameters::default()
    }
}
