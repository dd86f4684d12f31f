//! Folders on the way to a file.

use std::path::{Path, PathBuf};

/// The missing folders above and including this folder, the innermost first.
pub(super) fn missing_folders(folder: &Path) -> Vec<PathBuf> {
    let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    folder.ancestors().take_while(missing).map(Path::to_owned).collect()
}
