//! Ranges of frames as people write them.

use std::ops::Range;

/// A text that is no range of frames.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RangeError {
    /// Neither form.
    #[error(
        "expected A..B (from frame A up to but without frame B) or N (the first N frames), with \
         whole numbers up to 4294967295, got \"{0}\""
    )]
    Form(String),
    /// No frame is in it.
    #[error("there is no frame in {0}; the number after the dots is the first frame left out")]
    Empty(String),
}

/// Reads `A..B`, without B itself, or `N` for the first N frames.
///
/// # Errors
/// When the text has neither form, or no frame is in the range.
pub fn parse(text: &str) -> Result<Range<u32>, RangeError> {
    let number = |digits: &str| {
        let plain = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
        plain
            .then(|| digits.parse::<u32>().ok())
            .flatten()
            .ok_or_else(|| RangeError::Form(text.to_owned()))
    };
    let range = match text.split_once("..") {
        Some((start, end)) => number(start)?..number(end)?,
        None => 0..number(text)?,
    };
    if range.is_empty() { Err(RangeError::Empty(text.to_owned())) } else { Ok(range) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_are_read() {
        assert_eq!(parse("10"), Ok(0..10));
        assert_eq!(parse("5..8"), Ok(5..8));
        assert_eq!(parse("0..4294967295"), Ok(0..u32::MAX));
    }

    #[test]
    fn everything_else_is_refused() {
        for text in
            ["", "..", "5..", "..5", "-1", "+3", "1...3", "a", "1..b", "1.5", "4294967296", " 3"]
        {
            assert_eq!(parse(text), Err(RangeError::Form(text.to_owned())));
        }
        for text in ["0", "5..5", "8..5"] {
            assert_eq!(parse(text), Err(RangeError::Empty(text.to_owned())));
        }
    }
}
