//! Memory for what is as large as a picture or a mesh.

use rayon::prelude::*;
use std::mem::MaybeUninit;

/// Vectors of at least this many bytes are put on large pages: two of 2 MiB are certain to fit.
const LARGE: usize = 6 << 20;
/// One thread writes this many bytes.
const PART: usize = 1 << 20;

/// A vector of equal values, as `vec![value; count]`, on large pages if the system has some to give: its
/// addresses take less time to find. All threads of the current rayon pool write it: most of the time goes to pages that
/// the system clears at the first write.
pub fn filled<T: Copy + Send + Sync>(value: T, count: usize) -> Vec<T> {
    let mut values = Vec::with_capacity(count);
    // Before anything is written: pages are chosen by the first write.
    #[cfg(target_os = "linux")]
    ask_for_large_pages(values.spare_capacity_mut());
    if count.saturating_mul(size_of::<T>()) < LARGE {
        values.resize(count, value);
        return values;
    }
    let room = &mut values.spare_capacity_mut()[..count];
    let part = (PART / size_of::<T>()).max(1);
    room.par_chunks_mut(part).for_each(|part| part.fill(MaybeUninit::new(value)));
    // SAFETY: the first `count` values were just written.
    #[expect(unsafe_code, reason = "threads cannot extend one vector")]
    unsafe {
        values.set_len(count);
    }
    values
}

#[cfg(target_os = "linux")]
fn ask_for_large_pages<T>(memory: &mut [MaybeUninit<T>]) {
    use rustix::mm::{Advice, madvise};
    let page = rustix::param::page_size();
    let size = size_of_val(memory);
    let start = memory.as_mut_ptr().cast::<u8>();
    // Only pages that lie wholly within.
    let before = start.align_offset(page);
    let size = size.saturating_sub(before) / page * page;
    if size < LARGE {
        return;
    }
    // SAFETY: the pages are ours, and the advice changes nothing that a program can see in them. A system that
    // refuses the advice changes nothing.
    #[expect(unsafe_code, reason = "advice is given by address")]
    let _ = unsafe { madvise(start.wrapping_add(before).cast(), size, Advice::LinuxHugepage) };
}

#[cfg(test)]
mod tests {
    use super::filled;

    #[test]
    fn memory_of_any_size_is_filled() {
        for count in [0, 1, 1000, 3 << 20] {
            let values = filled(7_u32, count);
            assert!(values.len() == count && values.iter().all(|value| *value == 7));
        }
    }
}
