//! Turns sources into `assets/`; run by maintainers only.
//!
//! ```text
//! figurant-bake clips MOTIONS OUT     folder of humanoid3d_*.txt -> clips.clp
//! ```

mod clips;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let result = match args.as_slice() {
        ["clips", motions, out] => clips::bake_clips(Path::new(motions), Path::new(out))
            .map(|size| eprintln!("{out}: {size} bytes"))
            .map_err(|e| e.to_string()),
        _ => Err("usage: figurant-bake clips MOTIONS OUT".to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("figurant-bake: {message}");
            ExitCode::FAILURE
        }
    }
}
