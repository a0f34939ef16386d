//! Words of a Unity player's command line, as scripts around PeopleSansPeople hand them on.
//!
//! Next to `--scenario-config-file` they are left out and named; elsewhere they are as wrong as any
//! other.

use std::ffi::OsString;

/// Words without a value, and those with one, as the player knows them whatever their case.
const ALONE: [&str; 4] = ["-batchmode", "-nographics", "-quit", "-force-vulkan"];
const WITH_VALUE: [&str; 3] = ["-logfile", "-screen-width", "-screen-height"];
const SCENARIO: &str = "--scenario-config-file";

/// The words that are ours, and a note for each that is the player's.
pub fn split(words: Vec<OsString>) -> (Vec<OsString>, Vec<String>) {
    let is = |word: &OsString, names: &[&str]| {
        names.iter().any(|name| word.to_string_lossy().eq_ignore_ascii_case(name))
    };
    if !words.iter().any(|w| w.to_string_lossy().starts_with(SCENARIO)) {
        return (words, Vec::new());
    }
    let (mut ours, mut players) = (Vec::with_capacity(words.len()), Vec::new());
    let mut words = words.into_iter();
    while let Some(word) = words.next() {
        if is(&word, &ALONE) {
            players.push(told(word.to_string_lossy().into_owned()));
        } else if is(&word, &WITH_VALUE) {
            let value = words.next().unwrap_or_default();
            players.push(told(format!("{} {}", word.to_string_lossy(), value.to_string_lossy())));
        } else {
            ours.push(word);
        }
    }
    (ours, players)
}

fn told(words: String) -> String {
    format!("{words}: is a Unity player's and has no effect here")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_next_to_a_scenario_the_players_words_are_left_out() {
        let of = |line: &str| {
            let (ours, players) = split(line.split(' ').map(OsString::from).collect());
            let ours: Vec<String> = ours.iter().map(|w| w.to_string_lossy().into_owned()).collect();
            (ours.join(" "), players)
        };
        let (ours, players) =
            of("figurant export -logFile - --scenario-config-file=c.json -batchmode --out o");
        assert_eq!(ours, "figurant export --scenario-config-file=c.json --out o");
        assert!(players[0].starts_with("-logFile -:") && players[1].starts_with("-batchmode:"));
        let line = "figurant export c.json -logfile - --out o";
        assert_eq!(of(line), (line.to_owned(), Vec::new()));
        let (ours, players) = of("figurant export --scenario-config-file c.json -logfile");
        assert_eq!(
            (ours.as_str(), players.len()),
            ("figurant export --scenario-config-file c.json", 1)
        );
    }
}
