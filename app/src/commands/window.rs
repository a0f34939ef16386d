//! `figurant [CONFIG.json]`: the window.

use std::path::Path;

use crate::road::Road;
use crate::{Exit, Failure};

/// Opens it and waits until it is closed.
pub fn run<R: Road>(road: &R, config: Option<&Path>) -> Result<Exit, Failure> {
    // A misspelt command would open an empty window.
    if let Some(missing) = config.filter(|path| !path.exists()) {
        return Err(Failure::input(format!(
            "{}: there is no such file; `figurant --help` lists the commands",
            missing.display()
        )));
    }
    road.window(config).map(|()| Exit::Done).map_err(|reason| {
        let config = config.map_or_else(|| "CONFIG.json".into(), Path::to_string_lossy);
        Failure::new(
            Exit::NoWindow,
            format!(
                "no window can be opened: {reason}; without one, figurant export {config} --out \
                 DIR writes a data set and figurant frame {config} --frame 0 --out FILE.png a picture"
            ),
        )
    })
}
