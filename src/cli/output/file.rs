//! `-o FILE`: the destination of the one file of a run, and the way of writing it.

use super::folders::missing_folders;
use super::hidden::Hidden;
use super::sink::{Out, fill};
use crate::cli::failure::Failure;
use crate::cli::interrupt;
use crate::cli::reason::reason;
use std::ffi::OsStr;
use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A file to write. The destination is known before the work begins.
#[derive(Debug)]
pub(in crate::cli) struct OutputFile {
    /// The name from the command line.
    name: PathBuf,
    /// The option that names the file.
    option: &'static str,
    destination: Destination,
}

/// The destination of the content.
#[derive(Debug)]
enum Destination {
    /// Standard output, by `-` or by any other name.
    Stdout,
    /// A device or a pipe: the content is written directly, and the device is never replaced.
    Direct(PathBuf),
    /// A file, after all links are followed: the complete new file replaces the old file.
    File(PathBuf),
}

/// The most links to follow, the same number as on Linux.
const MOST_LINKS: usize = 40;

impl OutputFile {
    /// Finds the destination for the file name of `-o`.
    pub(in crate::cli) fn find(name: &Path) -> Result<OutputFile, Failure> {
        OutputFile::find_for("-o", name)
    }

    /// Finds the destination for the file name of another option.
    pub(in crate::cli) fn find_for(
        option: &'static str,
        name: &Path,
    ) -> Result<OutputFile, Failure> {
        let file = |destination| OutputFile { name: name.to_owned(), option, destination };
        destination(name).map(file).map_err(|error| failure(option, name, &error))
    }

    /// The ending of the name, in small letters; if the name has no ending, the ending of the name that it links to.
    pub(in crate::cli) fn ending(&self) -> Option<String> {
        let ending = |path: &Path| {
            // For the name `.ply`, the whole name is the ending.
            let bare = || path.file_name()?.to_str()?.strip_prefix('.').map(OsStr::new);
            path.extension().or_else(bare).map(OsStr::to_ascii_lowercase)
        };
        let ending = ending(&self.name).or_else(|| match &self.destination {
            Destination::File(path) => ending(path),
            Destination::Stdout | Destination::Direct(_) => None,
        });
        ending.map(|ending| ending.to_string_lossy().into_owned())
    }

    /// Whether the file is standard output. Then no other text may go to standard output.
    pub(in crate::cli) fn is_stdout(&self) -> bool {
        matches!(self.destination, Destination::Stdout)
    }

    /// The name in messages.
    pub(in crate::cli) fn said(&self) -> String {
        if self.name == Path::new("-") {
            "standard output".into()
        } else {
            self.name.display().to_string()
        }
    }

    /// Writes the content: to a temporary file in the same folder, which is renamed when it is complete.
    pub(in crate::cli) fn write(
        &self,
        content: impl FnOnce(&mut Out) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let written = match &self.destination {
            Destination::Stdout => into_stream(io::stdout().lock(), content),
            Destination::Direct(path) => {
                let opened = File::options().write(true).open(path);
                opened.and_then(|file| into_stream(file, content))
            }
            Destination::File(path) => replace(path, content),
        };
        written.map_err(|error| failure(self.option, &self.name, &error))
    }
}

fn destination(name: &Path) -> io::Result<Destination> {
    if name == Path::new("-") {
        return Ok(Destination::Stdout);
    }
    if name.as_os_str().is_empty() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "the name is empty"));
    }
    match fs::metadata(name) {
        Ok(there) if there.is_dir() => Err(ErrorKind::IsADirectory.into()),
        // Two handles must not write to the same file from two positions.
        Ok(there) if is_stdout(&there) => Ok(Destination::Stdout),
        Ok(there) if !there.is_file() => Ok(Destination::Direct(name.to_owned())),
        Ok(_) => fs::canonicalize(name).map(Destination::File),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            end_of_links(name).map(Destination::File)
        }
        Err(error) => Err(error),
    }
}

/// The file at the end of the links, if the file does not exist yet.
fn end_of_links(name: &Path) -> io::Result<PathBuf> {
    if name.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it names a folder"));
    }
    let mut path = name.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(link) = fs::read_link(&path) else { return Ok(path) };
        path = folder_of(&path).join(link);
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "it is a link that leads nowhere"))
}

/// The folder that a file is in.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(unix)]
fn is_stdout(file: &Metadata) -> bool {
    use std::os::fd::AsFd;
    use std::os::unix::fs::MetadataExt;
    let stdout = io::stdout().as_fd().try_clone_to_owned();
    let stdout = stdout.and_then(|stdout| File::from(stdout).metadata());
    stdout.is_ok_and(|stdout| (stdout.dev(), stdout.ino()) == (file.dev(), file.ino()))
}

#[cfg(not(unix))]
fn is_stdout(_file: &Metadata) -> bool {
    false
}

/// Writes to a stream, which cannot be replaced. Its reader may stop early.
fn into_stream(
    stream: impl Write + 'static,
    content: impl FnOnce(&mut Out) -> io::Result<()>,
) -> io::Result<()> {
    interrupt::streams();
    match fill(stream, content) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// Writes a new file in place of the old file, if there is one; creates the missing folders.
fn replace(path: &Path, content: impl FnOnce(&mut Out) -> io::Result<()>) -> io::Result<()> {
    let folder = folder_of(path);
    let created = missing_folders(folder);
    let written = replace_within(folder, &created, path, content);
    if written.is_err() {
        for folder in &created {
            // The call removes only empty folders.
            let _ = fs::remove_dir(folder);
        }
    }
    written
}

fn replace_within(
    folder: &Path,
    created: &[PathBuf],
    path: &Path,
    content: impl FnOnce(&mut Out) -> io::Result<()>,
) -> io::Result<()> {
    let mut held = interrupt::hold();
    fs::create_dir_all(folder)?;
    let hidden = Hidden::within(folder, created, &mut held)?;
    drop(held);
    let complete = hidden.path().join("file");
    let file = File::create(&complete)?;
    if let Ok(old) = fs::metadata(path) {
        // The new file gets the permissions of the old one.
        file.set_permissions(old.permissions())?;
    }
    fill(file, content)?;
    let mut held = interrupt::hold();
    fs::rename(&complete, path)?;
    held.placed(hidden.guard());
    // Dropping the hidden folder takes the lock that Ctrl-C waits for.
    drop(held);
    Ok(())
}

fn failure(option: &str, name: &Path, error: &io::Error) -> Failure {
    if name == Path::new("-") {
        let reason = reason(error, &format!("name a file with {option}"));
        return Failure::new(format!("cannot write to standard output: {reason}"));
    }
    let reason = reason(error, &format!("choose another file with {option}"));
    Failure::new(format!("cannot write {}: {reason}", name.display()))
}
