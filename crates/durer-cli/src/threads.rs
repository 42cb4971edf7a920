//! The threads that share the work.

use crate::failure::{Failure, in_words};
use crate::options::RunningArgs;
use std::io::{self, Write};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::available_parallelism;

/// Starts the requested number of threads, counting the main one: with a single thread, none is started. If the system
/// allows fewer, the existing ones do the work, with a warning; the pictures are the same.
pub fn start(args: &RunningArgs) -> Result<(), Failure> {
    let wanted = args.threads.map_or_else(usual, usize::from);
    // Threads are started first and get their part later, because a pool would wait for threads that it failed to
    // start.
    let (give, take) = channel::<rayon::ThreadBuilder>();
    let take = Arc::new(Mutex::new(take));
    let refused = (1..wanted).find_map(|made| waiting(&take).err().map(|error| (made, error)));
    let count = refused.as_ref().map_or(wanted, |(made, _)| *made);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .use_current_thread()
        .spawn_handler(move |thread| give.send(thread).map_err(|_| io::ErrorKind::Other.into()));
    pool.build_global().map_err(|_| Failure::Data("the threads cannot be prepared".to_owned()))?;
    if let Some((made, error)) = refused.filter(|_| !args.quiet) {
        let threads = if made == 1 { "thread does" } else { "threads do" };
        let why = in_words(&error);
        // If standard error is closed, the warning is lost.
        let _ = writeln!(
            io::stderr().lock(),
            "durer: warning: {made} {threads} the work, not {wanted}: {why}; --threads asks for fewer"
        );
    }
    Ok(())
}

/// Returns a thread that waits for its part.
fn waiting(take: &Arc<Mutex<Receiver<rayon::ThreadBuilder>>>) -> io::Result<()> {
    let take = Arc::clone(take);
    let work = move || {
        let part = take.lock().unwrap_or_else(PoisonError::into_inner).recv();
        if let Ok(part) = part {
            part.run();
        }
    };
    std::thread::Builder::new().spawn(work).map(drop)
}

/// Returns the number in `RAYON_NUM_THREADS`, or the number of processors.
fn usual() -> usize {
    let given = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse().ok());
    let processors = || available_parallelism().map_or(1, usize::from);
    given.filter(|&count| count > 0).unwrap_or_else(processors)
}
