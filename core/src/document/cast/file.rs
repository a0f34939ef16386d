//! Members in files of their own.
//!
//! ```json
//! {"name": "maria", "body": {"sex": "female", "age_years": 34}, "look": {"hair": "bun"}}
//! ```
//!
//! A file holds one person or a list `[ ]` of people, who take the place of the entry that names it.

use std::sync::LazyLock;

use serde_json::Value;

use super::Member;
use crate::base::hash::content_hash;
use crate::document::settle::{self, Files, SourceKind};
use crate::document::{Problem, check, validate};

/// Reads the files that a cast names and puts the people in their places. What is wrong with them,
/// by entry and file.
pub(in crate::document) fn fill(cast: &mut Vec<Member>, files: &mut Files) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut all = Vec::new();
    for (i, entry) in std::mem::take(cast).into_iter().enumerate() {
        let Some(name) = entry.file.clone() else {
            all.push(entry);
            continue;
        };
        match read(&name, files).and_then(|read| Ok((merge(entry, read.0)?, read.1))) {
            Ok((members, content_hash)) => {
                all.extend(members);
                files.add(&name, SourceKind::People, content_hash);
            }
            Err(found) => {
                let at = format!("people.cast[{i}].file");
                problems.extend(found.into_iter().map(|what| Problem::new(at.clone(), what)));
            }
        }
    }
    *cast = all;
    problems
}

/// The people that an entry with a file stands for.
fn merge(entry: Member, mut read: Vec<Member>) -> Result<Vec<Member>, Vec<String>> {
    let entry = Member { file: None, ..entry };
    if entry == Member::default() {
        return Ok(read);
    }
    match (read.pop(), read.len()) {
        (Some(only), 0) => Ok(vec![entry.or(only)]),
        (_, others) => Err(vec![format!(
            "it holds {} people, so that nothing but the file may stand in this entry; list the \
             person to be changed in a file of its own",
            others + 1
        )]),
    }
}

/// The people of a file, and the hash of its content; else what is wrong with it.
fn read(name: &str, files: &Files) -> Result<(Vec<Member>, String), Vec<String>> {
    let path = files.find(name).map_err(|what| vec![what])?;
    let (expected, otherwise) =
        ("a file of people such as maria.json", "split it into several files");
    let bytes = settle::bytes(&path, expected, otherwise)
        .map_err(|what| vec![format!("{}: {what}", path.display())])?;
    let members = parse(&bytes).map_err(|problems| {
        problems.iter().map(|what| format!("{}: {what}", path.display())).collect::<Vec<_>>()
    })?;
    Ok((members, content_hash(&bytes)))
}

/// The people in a file's content; else everything that is wrong with it.
fn parse(bytes: &[u8]) -> Result<Vec<Member>, Vec<String>> {
    static SCHEMA: LazyLock<Value> = LazyLock::new(|| schemars::schema_for!(Member).to_value());
    let one = |what: String| vec![what];
    let text = std::str::from_utf8(bytes)
        .map_err(|e| one(format!("not UTF-8 text (byte {}); expected JSON", e.valid_up_to())))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let not_json = |e: serde_json::Error| one(format!("not valid JSON: {e}"));
    let value: Value = serde_json::from_str(text).map_err(not_json)?;
    let checked: Vec<(String, &Value)> = match &value {
        Value::Array(items) if items.is_empty() => {
            return Err(one("holds nobody; expected at least one person".to_owned()));
        }
        Value::Array(items) => {
            items.iter().enumerate().map(|(i, item)| (format!("[{i}]"), item)).collect()
        }
        Value::Object(_) => vec![(String::new(), &value)],
        _ => return Err(one("expected one person { } or a list [ ] of people".to_owned())),
    };
    let problems: Vec<String> =
        checked.iter().flat_map(|(at, value)| located(at, check::check(value, &SCHEMA))).collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    // From the text: it shows a field that is given twice, a value does not.
    let members: Vec<Member> = match &value {
        Value::Array(_) => serde_json::from_str(text).map_err(not_json)?,
        _ => vec![serde_json::from_str(text).map_err(not_json)?],
    };
    let problems: Vec<String> = members
        .iter()
        .zip(&checked)
        .flat_map(|(member, (at, _))| located(at, validate::problems_of_member(member)))
        .collect();
    if problems.is_empty() { Ok(members) } else { Err(problems) }
}

/// Problems of the item at a place in a file, in words.
fn located(at: &str, problems: Vec<Problem>) -> impl Iterator<Item = String> {
    let dot = |path: &str| if at.is_empty() || path.is_empty() { "" } else { "." };
    problems.into_iter().map(move |p| {
        let path = format!("{at}{}{}", dot(&p.path), p.path);
        let path = if path.is_empty() { "the person".to_owned() } else { path };
        Problem { path, ..p }.to_string()
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::document::file::{MAX_BYTES, Problems};
    use crate::document::settle::{Settled, tests::load_people};

    /// A folder with a config that has a cast, and files beside it; what loading it says.
    fn load(cast: &str, files: &[(&str, &str)]) -> Result<Settled, Problems> {
        load_people(&format!(r#""identities": 4, "cast": {cast}"#), files)
    }

    #[test]
    fn files_are_found_beside_the_config_and_in_its_folders() {
        let files = [
            ("people/maria.json", r#"{"name": "maria", "body": {"age_years": 34}}"#),
            ("more/two.json", r#"[{"name": "one"}, {"name": "two"}]"#),
        ];
        let cast = r#"[{"name": "zero"}, {"file": "two.json"},
            {"file": "people/maria.json", "body": {"age_years": 70}}]"#;
        let settled = load(cast, &files).unwrap();
        let cast = &settled.document.people.cast;
        let names: Vec<_> = cast.iter().map(|m| m.name.as_deref().unwrap()).collect();
        assert_eq!(names, ["zero", "one", "two", "maria"]);
        assert_eq!(cast[3].body.age_years, Some(70.0));
        assert!(cast.iter().all(|m| m.file.is_none()));
        let sources: Vec<_> = settled.sources.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(sources, ["two.json", "people/maria.json"]);
        assert_eq!(settled.sources[0].content_hash, content_hash(files[1].1.as_bytes()));
    }

    #[test]
    fn files_that_are_no_people_are_refused_by_name() {
        let of = |text: &str| load(r#"[{}, {"file": "a.json"}]"#, &[("a.json", text)]);
        for (text, expected) in [
            ("", "not valid JSON"),
            ("[{", "not valid JSON"),
            ("3", "expected one person { } or a list [ ] of people"),
            ("[]", "holds nobody"),
            (r#"{"nmae": "x"}"#, "did you mean `name`?"),
            (r#"{"name": "a b"}"#, "name: must be"),
            (r#"{"name": "a", "name": "b"}"#, "duplicate field"),
            (r#"{"body": {"age_years": 0}}"#, "body.age_years: must be >= 1, got 0"),
            (r#"[{}, {"body": {"sex": "femal"}}]"#, "[1].body.sex: expected one of"),
            (r#"[{}, {"body": {"ancestry": [0, 0, 0]}}]"#, "[1].body.ancestry: at least one"),
            (r#"{"file": "b.json"}"#, "file: a file of people cannot name another one"),
            (r#"{"look": {"face": {"head-oval": 3}}}"#, "look.face.head-oval: must be <= 1, got 3"),
            (r#"[{}, {}, {}, {}]"#, "people.identities: must be at least 5"),
            (r#"[{"name": "a"}, {"name": "a"}]"#, "people.cast[2].name: \"a\" is also"),
        ] {
            let error = of(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
            let of_all =
                error.starts_with("people.identities") || error.starts_with("people.cast[2]");
            assert!(of_all || error.contains("people.cast[1].file: "), "{text}: {error}");
            assert!(of_all || error.contains("a.json"), "{text}: {error}");
        }
        let missing = load(r#"[{"file": "none.json"}]"#, &[]).unwrap_err().to_string();
        assert!(missing.starts_with("people.cast[0].file: there is no such file ("), "{missing}");
        assert!(missing.contains("more/none.json"), "{missing}");
        let folder = load(r#"[{"file": "more"}]"#, &[("more/a.json", "{}")]).unwrap_err();
        assert!(folder.to_string().contains("is a folder"), "{folder}");
        let both = load(r#"[{"file": "a.json", "name": "x"}]"#, &[("a.json", "[{}, {}]")]);
        assert!(both.unwrap_err().to_string().contains("holds 2 people"));
    }

    #[test]
    fn a_file_that_is_too_large_is_refused_unread() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("large.json");
        fs::File::create(&path).unwrap().set_len(MAX_BYTES + 1).unwrap();
        let files = Files { folders: vec![dir.path().to_owned()], sources: Vec::new() };
        let error = read("large.json", &files).unwrap_err();
        assert!(error[0].contains("large.json: has more than"), "{error:?}");
    }
}
