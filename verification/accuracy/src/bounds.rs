//! The promised error of each output: |error| <= k ε (1 + κ) scale, ε = 2⁻⁵².

#[derive(Debug)]
pub struct Bound {
    pub output: &'static str,
    /// k, in ε.
    pub k: f64,
    /// What the error is relative to.
    pub scale: &'static str,
    /// κ: relative change of the exact result per relative change of rounded inputs.
    pub condition: &'static str,
    pub domain: &'static str,
    pub reason: &'static str,
}

pub const EPSILON: f64 = f64::EPSILON;

const fn bound(
    output: &'static str,
    k: f64,
    scale: &'static str,
    condition: &'static str,
    domain: &'static str,
    reason: &'static str,
) -> Bound {
    Bound { output, k, scale, condition, domain, reason }
}

/// Output, k, scale, κ; domain and reason.
#[rustfmt::skip]
pub const BOUNDS: &[Bound] = &[
    bound("composite_modulus", 3.0, "value", "0",
        "every contact", "1-ν² as a product is free of cancellation: seven roundings"),
    bound("half_width", 5.0, "value", "0",
        "every contact", "w from Halley's iteration to rounding, a hypotenuse, and the rounding of E* and N/L"),
    bound("slip_force", 0.5, "value", "0",
        "every contact", "one product"),
    bound("slip_displacement", 6.0, "value", "1/x_s",
        "every contact", "x_s = Λ + β: the error of ln(2L/b) is absolute, and x_s may be below 1"),
    bound("initial_stiffness", 6.0, "value", "1/Λ",
        "every contact", "the error of ln(2L/b) is absolute, and Λ may be near 0"),
    bound("slip_energy", 48.0, "value", "0",
        "every contact", "β - γ, whose closed forms beyond ψ = π/3 lose up to four bits to cancellation"),
    bound("displacement", 10.0, "value", "τ/x",
        "0 <= T <= mu N", "up to τ = 1/2 a polynomial of positive curvature, beyond it Λτ + h(τ)"),
    bound("compliance", 5.0, "value", "(1 + τ h'')/(Λ+λ)",
        "0 <= T <= mu N", "Λ + λ, both positive; λ is sensitive to the rounding of T"),
    bound("stick_half_width", 5.0, "value", "τ h''",
        "0 <= T <= mu N", "a hypotenuse; c is sensitive to the rounding of T"),
    bound("dissipated_energy", 512.0, "value", "0",
        "0 <= T <= mu N", "just above τ = 1/2 the closed form is a difference of terms forty times as large"),
    bound("force", 8.0, "value", "1/(Λ+λ)",
        "any displacement", "two polynomials; at small Λ the closed form is inverted, with the rounding of Λ"),
    bound("stiffness", 10.0, "value", "(1 + (x+τ) h''/(Λ+λ))/(Λ+λ)",
        "any displacement", "the derivative of the same polynomial; sensitive to the rounding of the displacement and of Λ"),
    bound("stick_half_width_inverse", 10.0, "value", "(x+τ) h''/(Λ+λ)",
        "any displacement", "the stick zone by inversion of the closed form"),
    bound("pressure", 128.0, "value", "x/(b-x)",
        "any x", "antiderivatives that may lose six bits to cancellation; at an edge between the exact values at x (1 ± 8 ε)"),
    bound("shear", 128.0, "value", "x/(b-x) + x/abs(x-c) (1 + τ h'')",
        "any x, 0 <= T <= mu N",
        "as the pressure, over the slip zone only; at an edge between the exact values for 8 ε in x, b, c"),
    bound("slip", 128.0, "value", "1.5 x/(x-c) (1 + τ h'')",
        "any x, 0 <= T <= mu N", "as the shear"),
    bound("damage", 192.0, "value", "sum of both",
        "any x, 0 <= T <= mu N", "pressure times slip"),
    bound("masing_force", 8.0, "sum of the sizes of its terms", "1/Λ",
        "any history", "each reversal adds a term of the curve"),
    bound("masing_stiffness", 12.0, "value", "that of `stiffness`",
        "any history", "that of the branch; within some ε of gross slip between the exact values of neighbouring displacements"),
    bound("masing_dissipated", 512.0, "sum of its terms; 4 mu N times the farthest displacement if that slips", "3/Λ",
        "any history", "differences of cycle energies"),
    bound("masing_shear", 128.0, "sum of the sizes of its terms", "(x/abs(x-c) + 1/Λ)(1 + τ h'') + x/(b-x)",
        "any history, any x", "each reversal adds a traction; position and stick zones are rounded"),
    bound("loop_displacement", 3.0, "amplitude", "0",
        "any amplitude", "the cosine of a rounded angle up to π"),
    bound("loop_force", 10.0, "sum of the sizes of its terms", "1/Λ",
        "any amplitude", "two points of the curve, and a sine"),
    bound("k_real", 64.0, "value", "1/Λ",
        "any amplitude", "20 to 40 nodes that integrate to 1e-15 of the initial stiffness"),
    bound("k_imag", 512.0, "value", "3/Λ; beyond gross slip also 4x/e (6/512), from that of x_s",
        "any amplitude", "the energy, and the force of the amplitude"),
    bound("dk_real", 6000.0, "abs(K)/amplitude", "1/Λ",
        "any amplitude", "the same nodes, with larger weights; worst just above 1.05 times gross slip"),
    bound("dk_imag", 2048.0, "abs(K)/amplitude", "3/Λ",
        "any amplitude", "a difference of the derivative of the energy and of K''"),
    bound("harmonic_force", 8.0, "largest force, and initial stiffness times the sum of the coefficients", "1/Λ",
        "uniform sampling, against the definition of the rule", "sums over samples of points of the curve"),
    bound("harmonic_jacobian", 32.0, "initial stiffness", "1/Λ + Λ h''/(Λ+λ)³ times the sum of the coefficients",
        "uniform sampling, no sample within 1e-9 of gross slip", "sums over samples of stiffnesses"),
    bound("harmonic_dissipated", 512.0, "sum of its terms; 4 mu N times the coefficients if they slip", "3/Λ",
        "uniform sampling", "as `masing_dissipated`"),
    bound("event_driven_force", 32.0, "largest force, and initial stiffness times the farthest displacement", "1/Λ",
        "512 nodes, H = 1 with a mean, Λ >= 0.3, against the exact integrals",
        "the quadrature has converged: rounding of its sums"),
    bound("event_driven_jacobian", 8192.0, "initial stiffness", "1/Λ + x h''/(Λ+λ)² at both ends",
        "as above", "the stiffness is singular at gross slip: the error of 512 nodes"),
    bound("event_driven_64_force", 1e6, "as above", "1/Λ",
        "64 nodes, Λ >= 0.3: error of the quadrature", "decreases exponentially with the nodes"),
    bound("event_driven_64_jacobian", 1e9, "as above", "1/Λ + x h''/(Λ+λ)² at both ends",
        "64 nodes, Λ >= 0.3: error of the quadrature", "decreases as a power of the nodes in gross slip"),
    bound("event_driven_dissipated", 512.0, "value; 4 mu N times the amplitude if that slips", "3/Λ",
        "as above, 64 and 512 nodes", "the energy of branches, without quadrature"),
    bound("jenkins_stiffness", 512.0, "value", "3/Λ",
        "any amplitude", "K' and K''"),
    bound("jenkins_slip_force", 512.0, "value", "3/Λ",
        "any amplitude", "K' and K''"),
    bound("iwan_force_error", 1e10, "value, and 1e-9 of mu N", "0",
        "1 to 12 sliders", "bisection to 1e-6: against the largest distance of the sliders' polygon from the curve"),
    bound("force_steps_back", 4.0, "value", "1/Λ",
        "129 neighbouring doubles at every switch of formula", "largest decrease of an increasing quantity"),
    bound("displacement_steps_back", 4.0, "value", "1/Λ",
        "as above", "as above"),
    bound("energy_steps_back", 256.0, "value", "1/Λ",
        "as above", "as above"),
    bound("stick_half_width_steps_back", 4.0, "value", "1/Λ",
        "as above", "largest increase of a decreasing quantity"),
    bound("stiffness_steps_back", 8.0, "value", "1/Λ",
        "as above", "largest increase of a decreasing quantity"),
];

pub fn find(output: &str) -> &'static Bound {
    BOUNDS.iter().find(|bound| bound.output == output).unwrap_or_else(|| panic!("no bound for {output}"))
}
