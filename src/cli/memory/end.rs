//! Where memory ends: a message that says what to do, and the exit code of errors instead of a signal.

#[cfg(unix)]
use signal_hook::consts::SIGABRT;

/// From now on, a failed allocation is a message and exit code 2.
///
/// The standard library says `memory allocation of … bytes failed`, and raises `SIGABRT`; no code may run in between. The
/// next run removes the hidden folder of this one.
pub(in crate::cli) fn fail_where_memory_ends() {
    // Without it, the run ends without the message, or by the signal: this is no reason to refuse the run.
    #[cfg(target_os = "linux")]
    let _ = explain();
    #[cfg(unix)]
    {
        let always = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(true));
        let _ = signal_hook::flag::register_conditional_shutdown(SIGABRT, FAILURE, always);
    }
}

/// The exit code of errors.
#[cfg(unix)]
const FAILURE: i32 = 2;

/// Other faults abort, too: it does not claim to know.
#[cfg(target_os = "linux")]
const MESSAGE: &str = "\
error: the run was aborted; if an allocation failed, as the line above then says, allow more memory by --max-memory or \
ulimit -v where they limit it, or take a smaller --size, fewer --samples, one --order alone, or --stream for a mesh\n";

/// Lets a thread that waits from the beginning print the message and end the program.
///
/// A handler of the signal may neither allocate nor take a lock. It writes a byte to a pipe, which wakes the thread, and
/// another to a pipe that is full, where it stays until the thread has ended the program: the signal would do so earlier.
#[cfg(target_os = "linux")]
fn explain() -> std::io::Result<()> {
    use signal_hook::low_level::{exit, pipe::register};
    use std::io::{Read, Write, pipe};
    use std::os::fd::AsFd;
    let (mut woken, waking) = pipe()?;
    let (never_read, full) = pipe()?;
    let mut filled = full.try_clone()?;
    // Not by its lock: the thread that has failed may hold it.
    let mut stderr = std::fs::File::from(std::io::stderr().as_fd().try_clone_to_owned()?);
    let told = move || {
        if woken.read_exact(&mut [0]).is_ok() {
            let _ = stderr.write_all(MESSAGE.as_bytes());
            exit(FAILURE);
        }
        // Nobody waits for a pipe that nobody can read, nor if this thread cannot start.
        drop(never_read);
    };
    std::thread::Builder::new().name("memory".into()).stack_size(64 << 10).spawn(told)?;
    register(SIGABRT, waking)?;
    register(SIGABRT, full)?;
    // Registered, neither pipe waits: so this one can be filled. Then it waits again.
    let [page, byte] = [&[0; 4096][..], &[0]];
    for piece in [page, byte] {
        while filled.write(piece).is_ok() {}
    }
    rustix::io::ioctl_fionbio(&filled, false)?;
    Ok(())
}
