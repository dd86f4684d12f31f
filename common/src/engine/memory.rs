//! Memory for what is as large as a picture or a mesh.

/// From so many bytes on, large pages are asked for: two of 2 MiB are certain to fit.
#[cfg(target_os = "linux")]
const LARGE: usize = 6 << 20;

/// A vector of equal values, as `vec![value; count]`, on large pages if the system has some to give: its
/// addresses take less time to find.
pub fn filled<T: Copy>(value: T, count: usize) -> Vec<T> {
    let mut values = Vec::with_capacity(count);
    // Before anything is written: pages are chosen by the first write.
    #[cfg(target_os = "linux")]
    ask_for_large_pages(values.spare_capacity_mut());
    values.resize(count, value);
    values
}

#[cfg(target_os = "linux")]
fn ask_for_large_pages<T>(memory: &mut [std::mem::MaybeUninit<T>]) {
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
