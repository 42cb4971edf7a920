//! The functions that the module exports. A page writes a request into the buffer that [`durer_request`] returns, calls
//! [`durer_answer`], and reads the answer from the buffer that [`durer_result`] points to.
//!
//! No memory is handed over: both buffers belong to the module, and a page reads or writes them only between calls. So
//! no function here dereferences a pointer, and the only unsafe thing about them is that their names are exported as
//! they are.

#![allow(unsafe_code)]

use crate::{Answer, Engine};
use std::cell::RefCell;

/// Buffers between page and module, and the runs.
#[derive(Default)]
struct Door {
    request: Vec<u8>,
    result: Vec<u8>,
    engine: Engine,
}

thread_local! {
    static DOOR: RefCell<Door> = RefCell::default();
}

/// Returns a buffer of `length` bytes for the next request; null if there is no memory for it.
// SAFETY: no other function of a program has this name.
#[unsafe(no_mangle)]
pub extern "C" fn durer_request(length: usize) -> *mut u8 {
    DOOR.with_borrow_mut(|door| {
        door.request.clear();
        if door.request.try_reserve_exact(length).is_err() {
            return std::ptr::null_mut();
        }
        door.request.resize(length, 0);
        door.request.as_mut_ptr()
    })
}

/// Answers the request in the buffer. Returns 0 if the result is JSON, 1 for bytes, 2 for JSON of an error.
// SAFETY: no other function of a program has this name.
#[unsafe(no_mangle)]
pub extern "C" fn durer_answer() -> u32 {
    DOOR.with_borrow_mut(|door| {
        let request = std::mem::take(&mut door.request);
        let (kind, result) = match door.engine.answer(&request) {
            Answer::Json(text) => (0, text.into_bytes()),
            Answer::Bytes(bytes) => (1, bytes),
            Answer::Error(text) => (2, text.into_bytes()),
        };
        door.result = result;
        kind
    })
}

/// Returns where the result of the last answer begins; it stays there until the next one.
// SAFETY: no other function of a program has this name.
#[unsafe(no_mangle)]
pub extern "C" fn durer_result() -> *const u8 {
    DOOR.with_borrow(|door| door.result.as_ptr())
}

/// Returns the length of the result in bytes.
// SAFETY: no other function of a program has this name.
#[unsafe(no_mangle)]
pub extern "C" fn durer_result_length() -> usize {
    DOOR.with_borrow(|door| door.result.len())
}
