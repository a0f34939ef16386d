//! Numbers that were measured: tables in CSV files as laws of the document.
//!
//! ```text
//! age          age,people      lo,hi,weight
//! 23           23,120          0,5,310
//! 31           31,96           5,10,298
//! ```
//!
//! The first line names the columns, fields are parted by commas and may stand in double quotes
//! (RFC 4180). A column of values becomes a choice among them, each as often as it was measured; a
//! histogram becomes a mixture of uniform laws. Other columns are passed over.

use csv::{ErrorKind, Reader, ReaderBuilder, StringRecord, Trim};

use super::{Distribution, Empirical, Param};

/// Different values at most: more of them are better served by a histogram.
const MAX_VALUES: usize = 10_000;
/// Bins of a histogram at most.
const MAX_BINS: usize = 1000;
/// No number is larger than this, as anywhere in a document.
const LARGEST: f64 = 1e12;

/// The law in a file's content; else what is wrong with it, with line and column.
///
/// # Errors
/// When the text is no such table, has no such column, or holds what is no number.
pub fn law(empirical: &Empirical, bytes: &[u8]) -> Result<Distribution, String> {
    // A mark that some programs put before UTF-8.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut table = Table::new(bytes)?;
    match &empirical.column {
        Some(column) => values(&mut table, column, empirical.weight.as_deref()),
        None => histogram(&mut table, empirical.weight.as_deref().unwrap_or("weight")),
    }
}

/// Each value with its weight, from the smallest on.
fn values(table: &mut Table, column: &str, weight: Option<&str>) -> Result<Distribution, String> {
    let column = table.column(column)?;
    let weight = weight.map(|name| table.column(name)).transpose()?;
    let mut items: Vec<(f64, f64)> = Vec::new();
    while let Some(row) = table.next()? {
        let weight = weight.as_ref().map_or(Ok(1.0), |column| row.weight(column))?;
        items.push((row.number(&column)?, weight));
    }
    items.sort_by(|a, b| a.0.total_cmp(&b.0));
    items.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    if items.len() > MAX_VALUES {
        return Err(format!(
            "column {column}: {} different values, at most {MAX_VALUES} may be; write a histogram \
             with the columns lo, hi and weight, or round them",
            items.len()
        ));
    }
    some_weight(items.iter().map(|i| i.1))?;
    Ok(Distribution::Choice(items))
}

/// Bins from below upwards, each even within itself.
fn histogram(table: &mut Table, weight: &str) -> Result<Distribution, String> {
    let advice = "name a column of values by \"column\"";
    let [lo, hi] = ["lo", "hi"].map(|name| table.column(name));
    let lo = lo.map_err(|what| format!("{what}; {advice}"))?;
    let hi = hi.map_err(|what| format!("{what}; {advice}"))?;
    let weight = table.column(weight)?;
    let mut bins: Vec<(f64, Param)> = Vec::new();
    let mut end = f64::NEG_INFINITY;
    while let Some(row) = table.next()? {
        let (from, to, weight) = (row.number(&lo)?, row.number(&hi)?, row.weight(&weight)?);
        if from >= to {
            return Err(row.fault(&hi, &format!("must be > lo ({from}), got {to}")));
        }
        if from < end {
            return Err(row.fault(
                &lo,
                &format!("must be >= {end}, where the bin before it ends, got {from}"),
            ));
        }
        if bins.len() == MAX_BINS {
            return Err(format!("more than {MAX_BINS} bins; join some of them"));
        }
        end = to;
        bins.push((weight, Param::uniform(from, to)));
    }
    some_weight(bins.iter().map(|b| b.0))?;
    Ok(Distribution::Mix(bins))
}

fn some_weight(mut weights: impl ExactSizeIterator<Item = f64>) -> Result<(), String> {
    if weights.len() == 0 {
        return Err("holds no rows; expected at least one below the names of the columns".into());
    }
    weights.any(|w| w > 0.0).then_some(()).ok_or_else(|| "all weights are 0".to_owned())
}

/// A column by its number, with its name for people.
struct Column {
    index: usize,
    name: String,
}

impl std::fmt::Display for Column {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "\"{}\"", self.name)
    }
}

/// A file, row by row.
struct Table<'a> {
    reader: Reader<&'a [u8]>,
    names: StringRecord,
}

impl<'a> Table<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, String> {
        let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(bytes);
        let names = reader.headers().map_err(|e| in_words(&e))?.clone();
        if names.iter().all(str::is_empty) {
            return Err("is empty; expected a first line with the names of columns".to_owned());
        }
        Ok(Self { reader, names })
    }

    fn column(&self, name: &str) -> Result<Column, String> {
        let mut found = (0..self.names.len()).filter(|i| &self.names[*i] == name);
        match (found.next(), found.next()) {
            (Some(index), None) => Ok(Column { index, name: name.to_owned() }),
            (Some(_), Some(_)) => Err(format!("line 1: two columns are named \"{name}\"")),
            (None, _) => {
                let names: Vec<String> = self.names.iter().map(|n| format!("\"{n}\"")).collect();
                Err(format!("line 1: there is no column \"{name}\", only {}", names.join(", ")))
            }
        }
    }

    fn next(&mut self) -> Result<Option<Row>, String> {
        let mut fields = StringRecord::new();
        let more = self.reader.read_record(&mut fields).map_err(|e| in_words(&e))?;
        let line = fields.position().map_or(0, csv::Position::line);
        Ok(more.then_some(Row { line, fields }))
    }
}

/// A line of a table.
struct Row {
    line: u64,
    fields: StringRecord,
}

impl Row {
    fn fault(&self, column: &Column, what: &str) -> String {
        format!("line {}, column {column}: {what}", self.line)
    }

    fn number(&self, column: &Column) -> Result<f64, String> {
        // Rows are as long as the first line, or were refused.
        let text = self.fields.get(column.index).unwrap_or_default();
        match text.parse::<f64>() {
            // Adding 0 leaves no number but -0 another.
            Ok(value) if value.abs() <= LARGEST => Ok(value + 0.0),
            Ok(_) => Err(self.fault(column, &format!("must be at most {LARGEST:e}, got {text}"))),
            Err(_) => Err(self.fault(column, &format!("expected a number, got \"{text}\""))),
        }
    }

    fn weight(&self, column: &Column) -> Result<f64, String> {
        let weight = self.number(column)?;
        if weight < 0.0 {
            return Err(self.fault(column, &format!("a weight must be >= 0, got {weight}")));
        }
        Ok(weight)
    }
}

fn in_words(error: &csv::Error) -> String {
    let line = error.position().map_or(0, csv::Position::line);
    match error.kind() {
        ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("line {line}: expected {expected_len} fields as in line 1, got {len}")
        }
        ErrorKind::Utf8 { .. } => format!("line {line}: not UTF-8 text"),
        _ => format!("not a table of comma-separated values: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(names: &str, text: &str) -> Result<Distribution, String> {
        let empirical: Empirical = serde_json::from_str(names).unwrap();
        law(&empirical, text.as_bytes())
    }

    const AGES: &str = r#"{"file": "a.csv", "column": "age"}"#;
    const BINS: &str = r#"{"file": "a.csv"}"#;

    #[test]
    fn values_are_counted_and_put_in_order() {
        let expected = |items: &[(f64, f64)]| Ok(Distribution::Choice(items.to_vec()));
        let text = "\u{feff}id, age\r\n1, 31\r\n2,\"-2.5\"\r\n3,31\r\n4,-7\r\n\r\n5,0\n6,-0\n";
        assert_eq!(of(AGES, text), expected(&[(-7.0, 1.0), (-2.5, 1.0), (0.0, 2.0), (31.0, 2.0)]));
        let weighted = r#"{"file": "a.csv", "column": "age", "weight": "n"}"#;
        assert_eq!(of(weighted, "n,age\n3,40\n0,20\n"), expected(&[(20.0, 0.0), (40.0, 3.0)]));
    }

    #[test]
    fn histograms_become_mixtures() {
        let expected = Distribution::Mix(vec![
            (2.0, Param::uniform(0.0, 5.0)),
            (3.5, Param::uniform(7.0, 9.0)),
        ]);
        assert_eq!(of(BINS, "weight,lo,hi\n2,0,5\n3.5,7,9\n"), Ok(expected.clone()));
        let named = r#"{"file": "a.csv", "weight": "n"}"#;
        assert_eq!(of(named, "n,lo,hi\n2,0,5\n3.5,7,9"), Ok(expected));
    }

    #[test]
    fn what_is_no_such_table_is_named_by_line_and_column() {
        for (names, text, expected) in [
            (AGES, "", "is empty"),
            (AGES, "\n\n", "is empty"),
            (AGES, "age\n", "holds no rows"),
            (AGES, "years\n3\n", "line 1: there is no column \"age\", only \"years\""),
            (AGES, "age,age\n3,4\n", "line 1: two columns are named \"age\""),
            (AGES, "age,b\n3,4\nx,4\n", "line 3, column \"age\": expected a number, got \"x\""),
            (AGES, "age\n3\nNaN\n", "line 3, column \"age\": must be at most 1e12, got NaN"),
            (AGES, "age\n1e13\n", "line 2, column \"age\": must be at most 1e12, got 1e13"),
            (AGES, "age,b\n3,4\n5\n", "line 3: expected 2 fields as in line 1, got 1"),
            (BINS, "age\n3\n", "there is no column \"lo\", only \"age\"; name a column of values"),
            (BINS, "lo,hi\n3,4\n", "there is no column \"weight\""),
            (BINS, "lo,hi,weight\n3,3,1\n", "line 2, column \"hi\": must be > lo (3), got 3"),
            (BINS, "lo,hi,weight\n3,5,1\n4,6,1", "line 3, column \"lo\": must be >= 5, where"),
            (BINS, "lo,hi,weight\n3,5,-1\n", "line 2, column \"weight\": a weight must be >= 0"),
            (BINS, "lo,hi,weight\n3,5,0\n", "all weights are 0"),
        ] {
            let error = of(names, text).unwrap_err();
            assert!(error.contains(expected), "{text:?}: {error}");
        }
        let many: String = (0..=MAX_VALUES).map(|i| format!("{i}\n")).collect();
        let error = of(AGES, &format!("age\n{many}")).unwrap_err();
        assert!(error.contains("10001 different values, at most 10000"), "{error}");
        let empirical: Empirical = serde_json::from_str(AGES).unwrap();
        let error = law(&empirical, b"age\n3\n\xff\n").unwrap_err();
        assert_eq!(error, "line 3: not UTF-8 text");
    }
}
