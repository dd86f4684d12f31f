//! Why a file cannot be written.

use std::io::{self, ErrorKind};

/// The reason why a file cannot be written, in words if the system has only a number, and a remedy: the remedy for
/// this error, or `otherwise`.
pub(super) fn reason(error: &io::Error, otherwise: &str) -> String {
    let (cause, help) = match error.kind() {
        ErrorKind::NotFound => ("there is no such folder", ""),
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            ("a file is where a folder would be", "")
        }
        ErrorKind::IsADirectory => ("a folder of this name is there", ""),
        ErrorKind::PermissionDenied => ("there is no permission to", ""),
        ErrorKind::ReadOnlyFilesystem => ("the file system can only be read", ""),
        ErrorKind::StorageFull => ("no space is left on the device", "free some, or "),
        ErrorKind::QuotaExceeded => ("the quota of disk space is used up", "free some, or "),
        ErrorKind::FileTooLarge => ("files may not become so large", "raise the limit, or "),
        ErrorKind::ResourceBusy => ("another run is writing into it", "wait for it, or "),
        _ => {
            let text = error.to_string();
            let text = text.split(" (os error").next().unwrap_or_default();
            return format!("{text}; {otherwise}");
        }
    };
    format!("{cause}; {help}{otherwise}")
}
