//! The writer of all files: it stores the reason of a failed write, because encoders report that reason in their own
//! words or not at all.

use std::io::{self, BufWriter, ErrorKind, Write};

/// The writer of a file's content.
pub(in crate::cli) type Out = BufWriter<Sink>;

/// A writer that stores the system's error if a write fails.
pub(in crate::cli) struct Sink {
    to: Box<dyn Write>,
    failed: Option<io::Error>,
}

/// Writes the whole content, and returns the system's own error if that fails.
pub(super) fn fill(
    to: impl Write + 'static,
    content: impl FnOnce(&mut Out) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(Sink { to: Box::new(to), failed: None });
    let written = content(&mut out).and_then(|()| out.flush());
    written.map_err(|error| {
        // The writer does not try again to write the rest.
        let (sink, _) = out.into_parts();
        sink.failed.unwrap_or(error)
    })
}

impl Sink {
    fn note<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        if let Err(error) = &result
            && error.kind() != ErrorKind::Interrupted
        {
            let same = error.raw_os_error().map(io::Error::from_raw_os_error);
            self.failed = Some(same.unwrap_or_else(|| error.kind().into()));
        }
        result
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.to.write(bytes);
        self.note(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.to.flush();
        self.note(flushed)
    }
}

impl std::fmt::Debug for Sink {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sink").field("failed", &self.failed).finish_non_exhaustive()
    }
}
