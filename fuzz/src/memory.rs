//! How much memory work may take.

use peak_alloc::PeakAlloc;

#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// What any work may take, bytes.
const BASE: usize = 64 << 20;
/// What it may take besides, for each byte of input and output.
const EACH: usize = 64;

/// Does work on `input` bytes that makes as many bytes as it returns, and panics where it
/// took more memory than 64 MB and 64 bytes for each of them.
pub fn measured(input: usize, work: impl FnOnce() -> usize) {
    let before = HEAP.current_usage();
    HEAP.reset_peak_usage();
    let output = work();
    let taken = HEAP.peak_usage().saturating_sub(before);
    let allowed = BASE + EACH * (input + output);
    assert!(
        taken <= allowed,
        "took {taken} bytes of memory for {input} bytes in and {output} out: at most {allowed}"
    );
}
