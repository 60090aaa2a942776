//! Numbers as text.

/// The shortest digits that are read back as the same number.
pub fn format_number(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

pub fn format_list(values: &[f64]) -> String {
    values.iter().map(|value| format_number(*value)).collect::<Vec<_>>().join(",")
}

/// A number, also with the exponent of Fortran: 1.0D-06.
pub fn parse_number(text: &str) -> Result<f64, &'static str> {
    text.trim().replace(['d', 'D'], "e").parse().map_err(|_| match text.trim() {
        "" => "a number is missing; lists are written without blanks, or in quotes",
        text if text.contains(',') => "not a number; the decimal separator is a point",
        _ => "not a number",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_read_back() {
        let cases = [
            (2e11, "2e11"),
            (0.3, "0.3"),
            (5e-4, "5e-4"),
            (800.0, "800"),
            (-0.0, "-0"),
            (0.1 + 0.2, "0.30000000000000004"),
        ];
        for (value, text) in cases {
            assert_eq!(format_number(value), text);
            assert_eq!(parse_number(text).map(f64::to_bits), Ok(value.to_bits()));
        }
        assert_eq!(format_list(&[1.0, -2.5e-9]), "1,-2.5e-9");
        assert_eq!((parse_number(" 1.0D-06"), parse_number("5d-7 ")), (Ok(1e-6), Ok(5e-7)));
        for text in ["", "1O", "1.0-300", "1,5", "1 2"] {
            assert!(parse_number(text).is_err(), "{text}");
        }
    }
}
