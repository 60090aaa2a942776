//! Exit with a message if memory runs out. The standard library aborts, which leaves a core file and the status of a crash.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{self, Write};

struct ExitWithoutMemory;

#[global_allocator]
static ALLOCATOR: ExitWithoutMemory = ExitWithoutMemory;

fn checked(memory: *mut u8) -> *mut u8 {
    if memory.is_null() {
        // Neither allocates.
        let _ = io::stderr().write_all(b"error: out of memory\n");
        std::process::exit(1);
    }
    memory
}

// SAFETY: the allocator of the system under the same contract; a null pointer ends the process.
unsafe impl GlobalAlloc for ExitWithoutMemory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        checked(unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        checked(unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        checked(unsafe { System.realloc(memory, layout, size) })
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: guaranteed by the caller.
        unsafe { System.dealloc(memory, layout) }
    }
}
