//! `--max-memory SIZE`: the most memory that a run may take.

use crate::cli::failure::Failure;
use clap::Args;
use std::sync::OnceLock;

/// What a run may take from the machine.
#[derive(Debug, Args)]
#[command(next_help_heading = "Limits")]
pub(in crate::cli) struct LimitArgs {
    /// The most memory that the run may take, such as 500M or 2G. Frames and pictures that are known to need more are
    /// refused before they are drawn. On Linux nothing goes beyond it: a file whose content needs more, or anything
    /// else, ends the run with exit code 2, and nothing is written
    #[arg(long, value_name = "SIZE", value_parser = size, global = true,
          allow_hyphen_values = true)]
    max_memory: Option<u64>,
}

/// The least that can be asked for: the program by itself takes most of it.
const LEAST: u64 = 64 << 20;

/// The limit of this run.
static LIMIT: OnceLock<u64> = OnceLock::new();

/// The bytes that `--max-memory` allows, if it is given.
pub(super) fn given() -> Option<u64> {
    LIMIT.get().copied()
}

/// Limits the memory of this process from now on.
///
/// # Errors
///
/// A limit within which the threads of a run do not even start.
pub(in crate::cli) fn obey(args: &LimitArgs) -> Result<(), Failure> {
    if let Some(bytes) = args.max_memory {
        // The command line is read once.
        let _ = LIMIT.set(bytes);
        limit_process(bytes)
            .map_err(|error| Failure::new(format!("--max-memory cannot be set: {error}")))?;
    }
    if !is_limited() {
        return Ok(());
    }
    // Later, threads that cannot start would be a panic.
    rayon::ThreadPoolBuilder::new().build_global().map_err(|error| {
        Failure::new(format!(
            "cannot start the threads ({error}): allow more memory, or fewer threads by RAYON_NUM_THREADS=1"
        ))
    })
}

/// Limits what the process may write: its heap, the memory that it maps, and the stacks of its threads. A lower limit
/// that is there stays.
#[cfg(target_os = "linux")]
fn limit_process(bytes: u64) -> std::io::Result<()> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    let Rlimit { current, maximum } = getrlimit(Resource::Data);
    let least = current.map_or(bytes, |current| current.min(bytes));
    Ok(setrlimit(Resource::Data, Rlimit { current: Some(least), maximum })?)
}

#[cfg(not(target_os = "linux"))]
fn limit_process(_bytes: u64) -> std::io::Result<()> {
    Ok(())
}

/// Whether the system refuses memory to this process while the machine has some.
#[cfg(target_os = "linux")]
fn is_limited() -> bool {
    use rustix::process::{Resource, getrlimit};
    [Resource::Data, Resource::As].into_iter().any(|resource| getrlimit(resource).current.is_some())
}

#[cfg(not(target_os = "linux"))]
fn is_limited() -> bool {
    false
}

/// A number of bytes, with a unit of powers of 1024.
fn size(text: &str) -> Result<u64, String> {
    let example = "write a whole number with K, M, G or T, such as 500M or 2G";
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    let (number, unit) = text.split_at(digits);
    let shift = match unit.to_ascii_uppercase().as_str() {
        "" => 0,
        "K" | "KB" | "KIB" => 10,
        "M" | "MB" | "MIB" => 20,
        "G" | "GB" | "GIB" => 30,
        "T" | "TB" | "TIB" => 40,
        _ => return Err(example.into()),
    };
    if number.is_empty() {
        return Err(example.into());
    }
    // More than 64 bits count is no limit at all.
    let bytes = number.parse::<u64>().unwrap_or(u64::MAX);
    let bytes = bytes.saturating_mul(1 << shift);
    if bytes < LEAST {
        return Err(format!(
            "the program by itself takes most of {} MiB, the least that can be given; {example}",
            LEAST >> 20
        ));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_a_unit() {
        for (text, bytes) in [
            ("64M", 64 << 20),
            ("67108864", 64 << 20),
            ("500mb", 500 << 20),
            ("2G", 2 << 30),
            ("1TiB", 1 << 40),
            ("99999999999999999999T", u64::MAX),
        ] {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for bad in ["", "G", "-1G", "1.5G", "2 G", "2X", "much", "+2G"] {
            assert!(size(bad).unwrap_err().starts_with("write a whole number"), "{bad}");
        }
        for little in ["0", "2", "63M", "65535K"] {
            assert!(size(little).unwrap_err().contains("most of 64 MiB"), "{little}");
        }
    }
}
