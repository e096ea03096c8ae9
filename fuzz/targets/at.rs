#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| rubscope_fuzz::fuzz_laws::at(data));
