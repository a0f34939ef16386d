//! A folder with a config, in which command lines are run.

use std::fs;
use std::path::PathBuf;

use figurant::{Console, Exit, Stop};
use serde_json::{Value, json};

use super::painter::Atelier;

/// A folder with a config, and the program.
pub struct Desk {
    pub dir: tempfile::TempDir,
}

/// How a command line ended, and what it said.
pub struct Ran {
    pub exit: Exit,
    pub out: String,
    pub err: String,
}

impl Desk {
    pub fn new(config: &Value) -> Self {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("c.json"), config.to_string()).unwrap();
        Self { dir }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// Runs a command line; words that start with `@` are paths in the folder.
    pub fn run_with(&self, line: &str, stop: &Stop) -> Ran {
        let word = |w: &str| match w.strip_prefix('@') {
            Some(name) => self.path(name).into_os_string(),
            None => w.into(),
        };
        let args = ["figurant"].into_iter().chain(line.split_whitespace()).map(word);
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let exit =
            figurant::run(&Atelier, args, &mut Console::new(&mut out, &mut err, false), stop);
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Ran { exit, out: text(out), err: text(err) }
    }

    pub fn run(&self, line: &str) -> Ran {
        self.run_with(line, &Stop::new())
    }
}

pub fn desk() -> Desk {
    Desk::new(&json!({}))
}
