//! Root finding: Newton's method safeguarded by bisection.

/// Root of a function that is negative at `low` and not negative at `high`. `evaluate` returns value and derivative. A Newton step
/// that leaves the bracket is replaced by bisection; the iteration ends after a Newton step below 1e-9, whose successor would be
/// about the square of it.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_roots_are_found_from_any_start() {
        for exact in [0.1, 0.5, 1.9] {
            for start in [0.0, 0.3, 1.0, 2.0] {
                // The slope of atan is small away from the root: pure Newton iteration diverges.
                let f = |t: f64| ((50.0 * (t - exact)).atan(), 50.0 / (1.0 + (50.0 * (t - exact)).powi(2)));
                let root = bracketed_newton(0.0, 2.0, start, f);
                assert!((root - exact).abs() < 1e-15, "{exact} {start} {root}");
            }
        }
    }

    #[test]
    fn a_triple_root_and_a_root_at_the_end_of_the_bracket_are_found() {
        let triple = bracketed_newton(-1.0, 2.0, 1.5, |t| (t * t * t, 3.0 * t * t));
        assert!(triple.abs() < 1e-8, "{triple}");
        assert_eq!(bracketed_newton(0.0, 1.0, 0.2, |t| (t - 1.0, 1.0)), 1.0);
    }
}
