//! Errors as programs hand them on.

use durer_formats::{Error, NoResources, ReadOptions, read_model};
use std::io;

type Boxed = Box<dyn std::error::Error + Send + Sync + 'static>;

fn read(bytes: &[u8]) -> Result<u64, Boxed> {
    Ok(read_model(bytes, "a.obj", &NoResources, &ReadOptions::default())?.scene.triangle_count())
}

#[test]
fn errors_go_where_any_error_goes() {
    let error = read(b"v 1 2 x\n").expect_err("no number");
    assert!(matches!(error.downcast_ref(), Some(Error::Decode { .. })));
    assert!(error.source().is_none());
}

#[test]
fn errors_of_the_system_can_be_told_by_their_kind() {
    let error = Boxed::from(Error::from(io::Error::from(io::ErrorKind::StorageFull)));
    let source = error.source().and_then(|source| source.downcast_ref::<io::Error>());
    assert_eq!(source.map(io::Error::kind), Some(io::ErrorKind::StorageFull));
}

#[test]
fn errors_of_the_library_keep_their_words() {
    let inner = durer::Error::Cancelled;
    assert_eq!(Error::from(inner.clone()).to_string(), inner.to_string());
}
