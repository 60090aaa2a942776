//! Numbers as text.

/// The shortest digits that are read back as the same number.
pub fn format_number(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

pub fn format_list(values: &[f64]) -> String {
    values.iter().map(|value| format_number(*value)).collect::<Vec<_>>().join(",")
}

/// A number, also with the exponents of Fortran: 1.0D-06, 1.0-106.
pub fn parse_number(text: &str) -> Result<f64, &'static str> {
    let mut number = text.trim().replace(['d', 'D'], "e");
    let place = number.len().saturating_sub(4);
    if place > 0 && ["+", "-"].iter().any(|sign| number.get(place..).is_some_and(|end| end.starts_with(sign))) {
        let has_letter = number.contains(['e', 'E']);
        number.insert_str(place, if has_letter { "" } else { "e" });
    }
    number.parse().map_err(|_| match text.trim() {
        "" => "a number is missing; lists are written without blanks, or in quotes",
        text if text.contains(',') => "not a number; the decimal separator is a point",
        _ => "not a number",
    })
}
