//! How much memory is asked for at once, and how much is held.

#![allow(dead_code, reason = "no test uses all of it")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

thread_local! {
    static LARGEST: Cell<usize> = const { Cell::new(0) };
}

/// Bytes that have been given out and not taken back, on all threads.
static HELD: AtomicUsize = AtomicUsize::new(0);
/// Most of them since the last reset.
static MOST: AtomicUsize = AtomicUsize::new(0);

struct Watched;

#[global_allocator]
static ALLOCATOR: Watched = Watched;

fn note(size: usize) {
    // A thread that ends has no such cell any more, and asks for nothing of interest.
    let _ = LARGEST.try_with(|largest| largest.set(largest.get().max(size)));
}

/// Counts what the system has given in place of what it had given before.
fn count(given: *mut u8, before: usize, size: usize) -> *mut u8 {
    if !given.is_null() {
        let held = HELD.fetch_add(size, Ordering::Relaxed) + size;
        MOST.fetch_max(held, Ordering::Relaxed);
        HELD.fetch_sub(before, Ordering::Relaxed);
    }
    given
}

// SAFETY: everything is left to the allocator of the system; a cell without destructor is all that is added.
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
        count(unsafe { System.realloc(pointer, layout, size) }, layout.size(), size)
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

/// What `work` gives, and the most memory that all threads held meanwhile beyond that before, bytes.
pub fn most_held<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = held();
    MOST.store(before, Ordering::Relaxed);
    let result = work();
    (result, MOST.load(Ordering::Relaxed) - before)
}

/// What `work` gives, and the largest piece of memory it asked for on this thread, bytes.
pub fn largest<T>(work: impl FnOnce() -> T) -> (T, usize) {
    LARGEST.set(0);
    let result = work();
    (result, LARGEST.get())
}
