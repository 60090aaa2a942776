//! Numbers as text.

/// The shortest digits that read back as the same number.
pub fn digits(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

pub fn list(values: &[f64]) -> String {
    values.iter().map(|value| digits(*value)).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_short_and_read_back() {
        for (value, text) in [
            (2e11, "2e11"),
            (0.3, "0.3"),
            (5e-4, "5e-4"),
            (800.0, "800"),
            (-0.0, "-0"),
            (0.1 + 0.2, "0.30000000000000004"),
        ] {
            assert_eq!(digits(value), text);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(list(&[1.0, -2.5e-9]), "1,-2.5e-9");
    }
}
