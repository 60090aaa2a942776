//! Microslip friction law for blade contacts.
#![no_std]
extern crate std;
