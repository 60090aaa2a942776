//! The calls of the tests, for the target.

#[allow(dead_code, missing_docs, reason = "the valid arguments are those of the tests")]
#[path = "../../../tests/calls/mod.rs"]
pub mod interface;
