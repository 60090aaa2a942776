//! What both targets share: numbers made of bytes, guarded memory, counted calls that trap floating-point exceptions, and
//! contacts that are prepared once.
//!
//! What is unsafe in this package are the calls of the interface: pointers are NULL, or point to as much as the call says.

pub mod contacts;
pub mod interface;
pub mod memory;
pub mod source;
