//! Shared by both targets: numbers made of bytes, guarded memory, counted calls that trap floating-point exceptions, and contacts
//! that are initialised once.
//!
//! `unsafe` in this package are the calls of the interface: each pointer is NULL or valid for the given length.

pub mod contacts;
pub mod interface;
pub mod memory;
pub mod source;
