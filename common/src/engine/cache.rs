//! The caches of the machine.

use std::sync::OnceLock;

/// The bytes of the largest cache, shared by several cores or not; 0 where the machine does not tell.
///
/// It is for choices that change no result. On a machine that several virtual ones share, less of it may be ours; where cores
/// differ, it is that of the core that asks first.
pub fn largest_cache() -> usize {
    static BYTES: OnceLock<usize> = OnceLock::new();
    *BYTES.get_or_init(|| sizes().max().unwrap_or(0))
}

/// The sizes of the caches that hold data.
#[cfg(target_arch = "x86_64")]
fn sizes() -> impl Iterator<Item = usize> {
    use raw_cpuid::{CacheType, CpuId};
    let caches = CpuId::new().get_cache_parameters().into_iter().flatten();
    let caches = caches.take_while(|cache| cache.cache_type() != CacheType::Null);
    caches.filter(|cache| cache.cache_type() != CacheType::Instruction).map(|cache| {
        let line = cache.coherency_line_size() * cache.physical_line_partitions();
        line * cache.associativity() * cache.sets()
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
        if largest.is_empty() || largest_cache() == 0 {
            eprintln!("skipped: the system or the processor does not say");
            return;
        }
        assert!(largest.contains(&(largest_cache() >> 10)), "{largest:?}");
    }
}
