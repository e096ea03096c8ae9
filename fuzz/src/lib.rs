//! The laws of the tests, for the fuzzer.

#[path = "../../tests/all/fuzz_keys.rs"]
pub mod fuzz_keys;
#[path = "../../tests/all/fuzz_laws.rs"]
pub mod fuzz_laws;
#[path = "../../tests/all/stepwise.rs"]
mod stepwise;
