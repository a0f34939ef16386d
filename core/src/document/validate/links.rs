//! Which parameters may look at which others, and whether their tables hold what they may see.
//!
//! A parameter can look at what has one value where it is drawn itself: a person at the frame and at
//! that person's own numbers, but the frame not at one of its people. What lasts of people who recur
//! may not hang on what changes from frame to frame.

use std::collections::BTreeMap;

use crate::document::{Distribution, Given, Param, People, Problem, Scope};

/// Parameters by their paths, as the other checks found them.
type Params = BTreeMap<String, Param>;

/// Everything that is wrong with who looks at whom.
pub(super) fn check(params: &Params, people: &People) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut looks: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (holder, param) in params {
        for (path, given) in givens(holder, param) {
            match look(holder, &path, given, params, people) {
                None => looks.entry(holder).or_default().push(&given.of),
                Some(problem) => problems.push(problem),
            }
        }
    }
    problems.extend(circle(&looks));
    problems
}

/// The parameters that others look at, by their paths.
pub(super) fn targets(params: &Params) -> Params {
    let all = params.iter().flat_map(|(holder, param)| givens(holder, param));
    all.filter_map(|(_, given)| Some((given.of.clone(), params.get(&given.of)?.clone()))).collect()
}

/// The tables within a parameter, each with its path.
fn givens<'a>(holder: &str, param: &'a Param) -> impl Iterator<Item = (String, &'a Given)> {
    param.laws(holder).into_iter().filter_map(|(path, law)| match law {
        Distribution::Given(given) => Some((format!("{path}.given"), given)),
        _ => None,
    })
}

/// What is wrong with one look, if anything.
fn look(
    holder: &str,
    path: &str,
    given: &Given,
    params: &Params,
    people: &People,
) -> Option<Problem> {
    let of = given.of.as_str();
    let at_of = |what: String| Some(Problem::new(format!("{path}.of"), what));
    let Some(target) = params.get(of) else {
        let what = format!(
            "there is no parameter \"{of}\" to look at; name one that is a number or has a law in \
             this config (\"auto\" is none), such as \"people.body.age_years\""
        );
        let known = params.keys().map(String::as_str);
        return Some(Problem::new(format!("{path}.of"), what).did_you_mean(of, known));
    };
    if of.contains(".mix[") {
        let what = format!("\"{of}\" is part of a mixture of colours, which is not always drawn");
        return at_of(what);
    }
    let recur = people.identity_count().is_some();
    if let Some(why) = Scope::of(of).hidden_from(Scope::of_holder(holder), recur) {
        return at_of(format!("{holder} cannot look at {of}: {why}"));
    }
    let (from, to) = (given.table.first()?.0, given.table.last()?.1);
    let inside = |value: f64| (from..=to).contains(&value);
    let covers = format!("the table covers {from} to {to}; add the rows that are missing");
    let (min, max) = target.bounds();
    let read = target.laws("").iter().all(|(_, law)| !matches!(law, Distribution::Empirical(_)));
    if read && !(inside(min) && inside(max)) {
        let what = format!("{of} takes values from {min} to {max}, but {covers}");
        return Some(Problem::new(format!("{path}.table"), what));
    }
    let listed = people.cast.iter().enumerate().filter_map(|(i, m)| Some((i, m.number(of)?)));
    let (i, value) = listed.into_iter().find(|(_, value)| !inside(*value))?;
    let what = format!("people.cast[{i}] has {value} for {of}, but {covers}");
    Some(Problem::new(format!("{path}.table"), what))
}

/// A circle of parameters that look at each other, if there is one.
fn circle(looks: &BTreeMap<&str, Vec<&str>>) -> Option<Problem> {
    let mut done = Vec::new();
    looks.keys().find_map(|start| follow(start, looks, &mut Vec::new(), &mut done))
}

/// Goes from look to look; `way` is how it came here, `done` are those that lead to no circle.
fn follow<'a>(
    at: &'a str,
    looks: &BTreeMap<&'a str, Vec<&'a str>>,
    way: &mut Vec<&'a str>,
    done: &mut Vec<&'a str>,
) -> Option<Problem> {
    if let Some(first) = way.iter().position(|seen| *seen == at) {
        let circle = [&way[first..], &[at]].concat().join(" -> ");
        let what = format!("looks at itself ({circle}); let one of them have a law of its own");
        return Some(Problem::new(at, what));
    }
    if done.contains(&at) {
        return None;
    }
    way.push(at);
    let nexts = looks.get(at).into_iter().flatten();
    let found = nexts.into_iter().find_map(|next| follow(next, looks, way, done));
    way.pop();
    done.push(at);
    found
}
