//! The caches of the machine.

use std::sync::OnceLock;

/// The bytes of the largest cache, shared by several cores or not; 0 where the machine does not tell.
///
/// It is for choices that change no result. On a machine that several virtual ones share, less of it may be ours.
pub fn largest_cache() -> usize {
    static BYTES: OnceLock<usize> = OnceLock::new();
    *BYTES.get_or_init(|| sizes().max().unwrap_or(0))
}

/// The sizes of the caches that hold data.
///
/// Intel, "64 and IA-32 Architectures Software Developer's Manual", CPUID, leaf 4; AMD, "64 Architecture Programmer's
/// Manual", volume 3, CPUID, function 8000001D, which tells the same in the same form.
#[cfg(target_arch = "x86_64")]
fn sizes() -> impl Iterator<Item = usize> {
    use core::arch::x86_64::{__cpuid, __cpuid_count};
    const INSTRUCTIONS: u32 = 2;
    let leaves = [(0, 4), (0x8000_0000, 0x8000_001d)];
    let known = leaves.into_iter().filter(|(first, leaf)| __cpuid(*first).eax >= *leaf);
    known.flat_map(|(_, leaf)| {
        let all = (0..16).map(move |number| __cpuid_count(leaf, number));
        let all = all.take_while(|cache| cache.eax & 0x1f != 0);
        all.filter(|cache| cache.eax & 0x1f != INSTRUCTIONS).map(|cache| {
            let [line, parts, ways] = [cache.ebx & 0xfff, cache.ebx >> 12 & 0x3ff, cache.ebx >> 22]
                .map(|n| n as usize + 1);
            line * parts * ways * (cache.ecx as usize + 1)
        })
    })
}

#[cfg(not(target_arch = "x86_64"))]
fn sizes() -> impl Iterator<Item = usize> {
    std::iter::empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_cache_has_a_size_that_caches_have() {
        let bytes = largest_cache();
        println!("{} KiB", bytes >> 10);
        assert!(bytes == 0 || (1 << 17..1 << 33).contains(&bytes), "{bytes}");
        assert_eq!(bytes % 1024, 0);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn it_is_what_the_system_says() {
        let size_of = |core: usize, index: usize| {
            let file = format!("/sys/devices/system/cpu/cpu{core}/cache/index{index}/size");
            std::fs::read_to_string(file).ok()?.trim().strip_suffix('K')?.parse::<usize>().ok()
        };
        // Cores of different kinds may have different caches.
        let largest = |core: usize| (0..8).filter_map(|index| size_of(core, index)).max();
        let largest: Vec<usize> = (0..64).filter_map(largest).collect();
        if largest.is_empty() || !cfg!(target_arch = "x86_64") {
            eprintln!("skipped: the system or the processor does not say");
            return;
        }
        assert!(largest.contains(&(largest_cache() >> 10)), "{largest:?}");
    }
}
