//! What files are written through: it remembers why a write failed, which encoders say in words of their
//! own, or not at all.

use std::io::{self, BufWriter, ErrorKind, Write};

/// What a file's content is written to.
pub(in crate::cli) type Out = BufWriter<Sink>;

/// Takes bytes, and notes what the system said when it took no more.
pub(in crate::cli) struct Sink {
    to: Box<dyn Write>,
    failed: Option<io::Error>,
}

/// Writes all of a content, and gives the system's own reason if that fails.
pub(super) fn fill(
    to: impl Write + 'static,
    content: impl FnOnce(&mut Out) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(Sink { to: Box::new(to), failed: None });
    let written = content(&mut out).and_then(|()| out.flush());
    written.map_err(|error| {
        // What could not be written is not tried again.
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
