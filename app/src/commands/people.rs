//! `figurant people`: the people of a config as values, to be edited and listed in another.

use std::path::{Path, PathBuf};

use figurant_core::document::cast::{self, Member};
use figurant_core::document::file::MAX_BYTES;
use figurant_core::export::atomic;

use crate::args::PeopleArgs;
use crate::commands::not_loaded;
use crate::road::{Road, Wishes};
use crate::{Console, Exit, Failure};

/// Writes them, to one file or to a folder.
pub fn run<R: Road>(
    road: &R,
    args: &PeopleArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let wishes = Wishes { seed: args.seed, ..Wishes::default() };
    let job = road.load(&args.config, &wishes).map_err(|e| not_loaded(&args.config, e))?;
    let people = road
        .people(&job, args.frame)
        .map_err(|e| Failure::input(format!("{}: {e}", args.config.display())))?;
    let people = chosen(people, &args.person)?;
    let files = if is_file(&args.out) { one_file(args, &people)? } else { folder(args, &people)? };
    for (path, text) in &files {
        atomic::write(path, text.as_bytes()).map_err(Failure::input)?;
    }
    let noun = if people.len() == 1 { "person" } else { "people" };
    let name = files.first().map_or_else(String::new, |(path, _)| path.display().to_string());
    let more = if files.len() > 1 { ", ..." } else { "" };
    console.note(&format!(
        "{} {noun} -> {}; a config lists them as \
         \"people\": {{\"cast\": [{{\"file\": \"{name}\"}}{more}]}}, paths from its own folder",
        people.len(),
        args.out.display()
    ));
    Ok(Exit::Done)
}

/// Those whose ids were asked for, or all.
fn chosen(people: Vec<(u32, Member)>, ids: &[u32]) -> Result<Vec<(u32, Member)>, Failure> {
    if let Some(missing) = ids.iter().find(|id| people.iter().all(|(known, _)| known != *id)) {
        let known: Vec<String> = people.iter().take(30).map(|(id, _)| id.to_string()).collect();
        let more = if people.len() > known.len() { ", ..." } else { "" };
        return Err(Failure::input(format!(
            "--person {missing}: there is nobody of that id; there are {}{more}",
            known.join(", ")
        )));
    }
    Ok(people.into_iter().filter(|(id, _)| ids.is_empty() || ids.contains(id)).collect())
}

fn is_file(out: &Path) -> bool {
    !out.is_dir() && out.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"))
}

/// What is to be written where.
type Files = Vec<(PathBuf, String)>;

fn one_file(args: &PeopleArgs, people: &[(u32, Member)]) -> Result<Files, Failure> {
    free(args, &args.out)?;
    let members: Vec<Member> = people.iter().map(|(_, member)| member.clone()).collect();
    let text = match members.as_slice() {
        [only] => cast::text(only),
        all => cast::list_text(all),
    };
    if text.len() as u64 > MAX_BYTES {
        return Err(Failure::input(format!(
            "--out {}: {} people take {} bytes, but a file of people has at most {MAX_BYTES}; \
             name a folder instead",
            args.out.display(),
            members.len(),
            text.len()
        )));
    }
    Ok(vec![(args.out.clone(), text)])
}

/// A file for each, by id and name.
fn folder(args: &PeopleArgs, people: &[(u32, Member)]) -> Result<Files, Failure> {
    let out = &args.out;
    std::fs::create_dir_all(out)
        .map_err(|e| Failure::input(format!("--out {}: {e}", out.display())))?;
    let file = |(id, member): &(u32, Member)| {
        let name = match &member.name {
            Some(name) => format!("{id:04}-{name}.json"),
            None => format!("{id:04}.json"),
        };
        let path = out.join(name);
        free(args, &path)?;
        Ok((path, cast::text(member)))
    };
    people.iter().map(file).collect()
}

/// Refuses to write over what somebody may have edited.
fn free(args: &PeopleArgs, path: &Path) -> Result<(), Failure> {
    if args.overwrite || !path.exists() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{}: is there already; give --overwrite to replace it",
        path.display()
    )))
}
