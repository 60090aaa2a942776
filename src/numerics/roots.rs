//! Root finding: Newton's method safeguarded by bisection, and in logarithms.

/// Root of a function that is negative at `low` and not negative at `high`. `evaluate` returns value and derivative. A
/// Newton step that leaves the bracket is replaced by bisection. The iteration ends after a Newton step below 1e-9,
/// because the next step would be about its square.
pub(crate) fn bracketed_newton(low: f64, high: f64, start: f64, evaluate: impl Fn(f64) -> (f64, f64)) -> f64 {
    let start = if start >= low && start <= high { start } else { 0.5 * (low + high) };
    let (mut low, mut high, mut at) = (low, high, start);
    for _ in 0..80 {
        let (value, slope) = evaluate(at);
        if value < 0.0 {
            low = at;
        } else {
            high = at;
        }
        // The lower bound on the slope limits the step to 100 and prevents a division by zero.
        let slope = if slope > 0.0 { slope } else { 0.0 };
        let newton = at - value / slope.max(0.01 * value.abs()).max(f64::MIN_POSITIVE);
        let inside = newton >= low && newton <= high;
        let next = if inside { newton } else { 0.5 * (low + high) };
        let step = (next - at).abs();
        at = next;
        if (inside && step < 1e-9) || high - low < 1e-15 {
            break;
        }
    }
    at
}

/// The argument at which a growing function has a given value > 0, by Newton's method in the logarithms of argument and
/// function. `function` returns the function and the derivative of its logarithm with respect to the logarithm of the
/// argument. If the function hardly grows, a step reduces the argument to at least a twentieth. For a function whose
/// logarithm is concave, steps upwards do not pass the root.
pub(crate) fn logarithmic_newton(value: f64, start: f64, function: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut argument = start;
    for _ in 0..30 {
        let [found, power] = function(argument);
        let step = ((value / found).ln() / power).max(-3.0);
        argument *= step.exp();
        // Quadratic convergence: the next step is below rounding.
        if step.abs() < 1e-8 {
            break;
        }
    }
    argument
}
