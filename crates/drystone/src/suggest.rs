//! The nearest existing name to a mistyped one.

/// The candidate with the smallest edit distance to `given`, if at most a third of the letters of
/// the longer of the two would have to change. Ties go to the first candidate.
///
/// Names that differ in their digits only are different names ("9" and "1", "b3" and "b4"), and
/// neither is a mistyped other.
pub(crate) fn nearest<'a>(given: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let limit = given.chars().count().max(candidate.chars().count()) / 3;
        if numbered_alike(given, candidate) {
            continue;
        }
        let distance = edit_distance(given, candidate);
        if distance <= limit && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, name)| name.to_owned())
}

/// Whether two names are the same but for their digits.
fn numbered_alike(a: &str, b: &str) -> bool {
    let letters = |name: &str| name.to_lowercase().replace(|c: char| c.is_ascii_digit(), "");
    letters(a) == letters(b) && !a.eq_ignore_ascii_case(b)
}

/// Levenshtein distance in characters, upper and lower case alike.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.to_lowercase().chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn suggests_only_what_is_close() {
        let names = ["friction", "fixed", "density"];
        assert_eq!(nearest("fricton", names).as_deref(), Some("friction"));
        assert_eq!(nearest("Fixed", names).as_deref(), Some("fixed"));
        assert_eq!(nearest("colour", names), None);
        assert_eq!(nearest("grnd", ["ground"]).as_deref(), Some("ground"));
    }

    #[test]
    fn numbers_are_not_mistyped_others() {
        assert_eq!(nearest("9", ["1", "19"]), None);
        assert_eq!(nearest("b3", ["b1", "b31", "c3"]), None);
        assert_eq!(nearest("block 12", ["block 1", "block 13"]), None);
        assert_eq!(nearest("blok 12", ["block 12"]).as_deref(), Some("block 12"));
        assert_eq!(nearest("B3", ["b3"]).as_deref(), Some("b3"));
    }
}
