//! Contacts initialised once, from the cylinder to the nearly flat, short, long, open, without friction, in extreme units, so that
//! inputs need not initialise their own.

use crate::interface::status;
use crate::source::Source;
use microslip::ffi::{mslip_contact, mslip_contact_init, mslip_contact_init_elliptic};
use microslip::{EllipticParameters, Material, Parameters};
use std::sync::OnceLock;

/// Doubles of a contact.
pub const SIZE: usize = size_of::<mslip_contact>() / size_of::<f64>();

pub type Bits = [f64; SIZE];

pub const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

pub fn flat(flat_half_width: f64) -> Parameters {
    Parameters {
        flat_half_width,
        edge_radius: 1e-2,
        length: 1e-2,
        normal_force: 100.0,
        friction_coefficient: 0.5,
        material: [STEEL; 2],
        ..Parameters::default()
    }
}

pub fn ellipse(semi_axis_x: f64, semi_axis_y: f64) -> EllipticParameters {
    EllipticParameters {
        semi_axis_x,
        semi_axis_y,
        normal_force: 100.0,
        friction_coefficient: 0.5,
        material: [STEEL; 2],
    }
}

fn draw_material(source: &mut Source) -> [Material; 2] {
    [(); 2].map(|()| Material {
        young_modulus: source.magnitude(2e11),
        poisson_ratio: match source.byte() {
            0..128 => 0.3,
            128 => 0.0,
            129 => 0.5,
            _ => source.magnitude(0.3),
        },
    })
}

/// Parameters that are allowed mostly.
pub fn draw_flat(source: &mut Source) -> Parameters {
    let byte = source.byte();
    Parameters {
        flat_half_width: if byte & 4 == 0 { source.magnitude(1e-3) } else { 0.0 },
        edge_radius: source.magnitude(1e-2),
        length: source.magnitude(1e-2),
        normal_force: source.magnitude(100.0),
        friction_coefficient: source.magnitude(0.5),
        displacement_reference: if byte < 0xf0 { (byte & 1).into() } else { byte as i8 as i32 },
        reserved: byte.into(),
        material: draw_material(source),
    }
}

pub fn draw_ellipse(source: &mut Source) -> EllipticParameters {
    EllipticParameters {
        semi_axis_x: source.magnitude(1e-4),
        semi_axis_y: source.magnitude(2e-4),
        normal_force: source.magnitude(100.0),
        friction_coefficient: source.magnitude(0.5),
        material: draw_material(source),
    }
}

/// What a contact is made of.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    Flat(Parameters),
    Ellipse(EllipticParameters),
}

impl Given {
    /// The same in other units of length and force.
    pub fn scaled(self, length: f64, force: f64) -> Given {
        let material = |[one, two]: [Material; 2]| {
            [one, two].map(|body| Material { young_modulus: body.young_modulus * force / length / length, ..body })
        };
        match self {
            Given::Flat(p) => Given::Flat(Parameters {
                flat_half_width: p.flat_half_width * length,
                edge_radius: p.edge_radius * length,
                length: p.length * length,
                normal_force: p.normal_force * force,
                material: material(p.material),
                ..p
            }),
            Given::Ellipse(p) => Given::Ellipse(EllipticParameters {
                semi_axis_x: p.semi_axis_x * length,
                semi_axis_y: p.semi_axis_y * length,
                normal_force: p.normal_force * force,
                material: material(p.material),
                ..p
            }),
        }
    }

    /// The contact, or the status that refuses it.
    pub fn prepare(&self) -> Result<Bits, i32> {
        let mut bits = [0.0; SIZE];
        let contact = bits.as_mut_ptr().cast();
        let status = match self {
            Given::Flat(p) => status("mslip_contact_init", true, || unsafe { mslip_contact_init(p, contact) }),
            Given::Ellipse(p) => {
                status("mslip_contact_init_elliptic", true, || unsafe { mslip_contact_init_elliptic(p, contact) })
            }
        };
        if status == 0 { Ok(bits) } else { Err(status) }
    }
}

pub fn all() -> &'static [(Given, Bits)] {
    static CONTACTS: OnceLock<Vec<(Given, Bits)>> = OnceLock::new();
    CONTACTS.get_or_init(|| {
        let unlike = [STEEL, Material { young_modulus: 7e10, poisson_ratio: 0.5 }];
        let rubber = [Material { young_modulus: 1e6, poisson_ratio: 0.0 }; 2];
        let flats = [
            flat(0.0),
            flat(1e-9),
            flat(50e-6),
            flat(1e-3),
            flat(9e-3),
            // Short, and long.
            Parameters { length: 1.43e-4, ..flat(0.0) },
            Parameters { length: 4.51e-3, ..flat(9e-3) },
            Parameters { length: 1e6, ..flat(0.0) },
            Parameters { displacement_reference: 1, ..flat(0.0) },
            Parameters { displacement_reference: 1, material: unlike, ..flat(2e-4) },
            Parameters { material: rubber, length: 1.0, ..flat(1e-3) },
            Parameters { normal_force: 1e-12, ..flat(1e-3) },
            Parameters { normal_force: 0.0, ..flat(1e-3) },
            Parameters { friction_coefficient: 0.0, ..flat(1e-3) },
            Parameters { friction_coefficient: 1e30, ..flat(50e-6) },
        ];
        let open = EllipticParameters { normal_force: 0.0, ..ellipse(1e-4, 1e-4) };
        let ellipses = [ellipse(1e-4, 1e-4), ellipse(1e-5, 1e-3), ellipse(1e-2, 1e-4), ellipse(1e60, 1e61), open];
        let wild = [
            Given::Flat(flat(50e-6)).scaled(2f64.powi(120), 2f64.powi(-100)),
            Given::Flat(flat(0.0)).scaled(2f64.powi(-90), 2f64.powi(200)),
        ];
        let given = flats.map(Given::Flat).into_iter().chain(ellipses.map(Given::Ellipse)).chain(wild);
        let prepared = |given: Given| (given, given.prepare().unwrap_or_else(|status| panic!("{given:?}: {status}")));
        given.map(prepared).collect()
    })
}
