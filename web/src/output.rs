//! Writes the page.

use crate::failure::Failure;
use std::fs;
use std::io::Write;
use std::path::Path;
use tempfile::NamedTempFile;

/// Writes a text under a temporary name beside the file, and renames it: nobody ever sees half a page. Missing folders are
/// made; a link is followed.
pub(crate) fn write(file: &Path, text: &str) -> Result<(), Failure> {
    written(file, text).map_err(|error| Failure::Output { path: file.to_owned(), error })
}

fn written(file: &Path, text: &str) -> std::io::Result<()> {
    let file = &fs::canonicalize(file).unwrap_or_else(|_| file.to_owned());
    if file.is_dir() {
        return Err(std::io::ErrorKind::IsADirectory.into());
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut temporary = NamedTempFile::with_prefix_in(".bothways-", folder)?;
    temporary.write_all(text.as_bytes())?;
    // A page is for everyone, as other files are; a temporary file is for its owner alone.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(file).map_or(0o644, |there| there.permissions().mode());
        temporary.as_file().set_permissions(fs::Permissions::from_mode(mode))?;
    }
    temporary.persist(file)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_replaced_and_folders_are_made() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("new/page.html");
        for text in ["one", "two"] {
            write(&file, text).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        assert_eq!(fs::read_dir(file.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_is_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let says = write(folder.path(), "").unwrap_err().to_string();
        assert!(says.ends_with("is a directory; choose another file with -o"), "{says}");
    }
}
