//! Files that a file names: in its folder, or below it.

use std::io;
use std::path::{Path, PathBuf};

/// Why a file that a file names is not read.
#[derive(Debug)]
pub(crate) enum PathFault {
    /// It is somewhere else.
    Outside,
    /// The system reports an error.
    Unreadable(io::Error),
}

/// The file of a name, which exists, and is in a folder or below it, also behind links. Parts of the name are separated by
/// `/` or `\`.
pub(crate) fn within(folder: &Path, name: &str) -> Result<PathBuf, PathFault> {
    let parts = || name.split(['/', '\\']);
    // A path from the root, or behind a drive or a scheme.
    let begins_outside = parts().next().is_some_and(|first| first.contains(':'))
        || name.starts_with(['/', '\\'])
        || name.is_empty();
    // A path that leads out is refused whether the file exists or not.
    let mut depth = 0_i64;
    for part in parts() {
        depth += match part {
            ".." => -1,
            "" | "." => 0,
            _ => 1,
        };
        if depth < 0 {
            return Err(PathFault::Outside);
        }
    }
    if begins_outside {
        return Err(PathFault::Outside);
    }
    let folder = if folder == Path::new("") { Path::new(".") } else { folder };
    let folder = folder.canonicalize().map_err(PathFault::Unreadable)?;
    let path = folder.join(name).canonicalize().map_err(PathFault::Unreadable)?;
    if path.starts_with(&folder) { Ok(path) } else { Err(PathFault::Outside) }
}
