//! Largest request of memory, and memory held.

#![allow(dead_code, reason = "no test uses all of it")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

thread_local! {
    static LARGEST: Cell<usize> = const { Cell::new(0) };
}

/// Bytes allocated and not freed, on all threads.
static HELD: AtomicUsize = AtomicUsize::new(0);
/// Largest value of `HELD` since the last reset.
static MOST: AtomicUsize = AtomicUsize::new(0);

struct Watched;

#[global_allocator]
static ALLOCATOR: Watched = Watched;

fn note(size: usize) {
    // A thread that ends has no such cell any more, and its requests do not matter.
    let _ = LARGEST.try_with(|largest| largest.set(largest.get().max(size)));
}

/// Counts a block given by the system in place of `before` bytes.
fn count(given: *mut u8, before: usize, size: usize) -> *mut u8 {
    if !given.is_null() {
        let held = HELD.fetch_add(size, Ordering::Relaxed) + size;
        MOST.fetch_max(held, Ordering::Relaxed);
        HELD.fetch_sub(before, Ordering::Relaxed);
    }
    given
}

// SAFETY: all work is left to the allocator of the system; only a cell without destructor is added.
unsafe impl GlobalAlloc for Watched {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        count(unsafe { System.alloc(layout) }, 0, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        count(unsafe { System.alloc_zeroed(layout) }, 0, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note(size);
        count(
            unsafe { System.realloc(pointer, layout, size) },
            layout.size(),
            size,
        )
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Bytes held by all threads at this moment.
pub fn held() -> usize {
    HELD.load(Ordering::Relaxed)
}

/// Result of `work`, and the most memory that all threads held meanwhile beyond that before, bytes.
pub fn most_held<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = held();
    MOST.store(before, Ordering::Relaxed);
    let result = work();
    (result, MOST.load(Ordering::Relaxed) - before)
}

/// Result of `work`, and its largest single request of memory on this thread, bytes.
pub fn largest<T>(work: impl FnOnce() -> T) -> (T, usize) {
    LARGEST.set(0);
    let result = work();
    (result, LARGEST.get())
}
