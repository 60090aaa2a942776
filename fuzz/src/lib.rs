//! What both targets share: numbers made of bytes, guarded memory, counted calls that trap floating-point exceptions, and
//! contacts that are prepared once.

pub mod contacts;
pub mod interface;
pub mod memory;
pub mod source;
