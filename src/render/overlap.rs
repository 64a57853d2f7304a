//! Work on many frames at a time, with few of them in memory.

use rayon::Yield;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, channel, sync_channel};
use std::time::Duration;

/// Draws frames in order on one thread of the pool, works each out in parallel, and hands them
/// over in order on a thread of its own; all three at the same time, with a few
/// frames under way. `work` sees a frame and the one before.
///
/// Stops at the first error, of which that of `hand_over` comes first.
pub(super) fn overlap<D, R, E>(
    count: usize,
    mut draw: impl FnMut(usize) -> Result<D, E> + Send,
    work: impl Fn(&D, Option<&D>) -> R + Sync,
    hand_over: impl FnMut(usize, R) -> Result<(), E> + Send,
) -> Result<(), E>
where
    D: Send + Sync,
    R: Send,
    E: Send,
{
    // A permit for each frame under way: taken before it is drawn, given back
    // when it has been handed over.
    let (permits, taken) = sync_channel(2 * rayon::current_num_threads() + 2);
    let (done, ready) = channel();
    std::thread::scope(|threads| {
        let last = threads.spawn(move || in_order(ready, taken, hand_over));
        // A thread of the pool shares out its work without waking others for each piece.
        let drawn = rayon::scope(|tasks| {
            let mut before: Option<Arc<D>> = None;
            for index in 0..count {
                if !acquire(&permits) {
                    break;
                }
                let frame = Arc::new(draw(index)?);
                let (this, before, done, work) = (frame.clone(), before.replace(frame), done.clone(), &work);
                // Where the receiver is gone, an error is on its way already.
                tasks.spawn(move |_| drop(done.send((index, work(&this, before.as_deref())))));
            }
            Ok(())
        });
        drop(done);
        let handed = last.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        handed.and(drawn)
    })
}

/// Waits for a permit; false when nothing is handed over any more.
fn acquire(permits: &SyncSender<()>) -> bool {
    loop {
        match permits.try_send(()) {
            Ok(()) => return true,
            Err(TrySendError::Disconnected(())) => return false,
            // On a thread of the pool, waiting would keep others from their work.
            Err(TrySendError::Full(())) => match rayon::yield_now() {
                Some(Yield::Executed) => {}
                Some(Yield::Idle) => std::thread::sleep(Duration::from_micros(50)),
                None => return permits.send(()).is_ok(),
            },
        }
    }
}

fn in_order<R, E>(
    ready: Receiver<(usize, R)>,
    permits: Receiver<()>,
    mut hand_over: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let (mut waiting, mut next) = (BTreeMap::new(), 0);
    for (index, frame) in ready {
        waiting.insert(index, frame);
        while let Some(frame) = waiting.remove(&next) {
            hand_over(next, frame)?;
            // Its permit was sent before it was drawn.
            let _ = permits.recv();
            next += 1;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn frames_arrive_in_order_and_few_are_under_way() {
        let under_way = AtomicUsize::new(0);
        let most = AtomicUsize::new(0);
        let mut out = Vec::new();
        let draw = |i: usize| {
            most.fetch_max(under_way.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
            Ok::<_, ()>(i)
        };
        let work = |this: &usize, before: Option<&usize>| {
            // Some take longer than others.
            std::thread::sleep(Duration::from_millis(if this.is_multiple_of(7) { 5 } else { 0 }));
            (*this, before.copied())
        };
        let hand_over = |index: usize, frame: (usize, Option<usize>)| {
            under_way.fetch_sub(1, Ordering::SeqCst);
            assert_eq!((index, index.checked_sub(1)), frame);
            out.push(index);
            Ok(())
        };
        overlap(200, draw, work, hand_over).unwrap();
        assert!(out.into_iter().eq(0..200));
        assert!(most.into_inner() <= 2 * rayon::current_num_threads() + 3);
    }

    #[test]
    fn errors_of_either_end_stop_the_work() {
        let at = |n: usize| move |i: usize| if i == n { Err("draw") } else { Ok(i) };
        let pass = |_: usize, _: usize| Ok(());
        assert_eq!(overlap(100, at(30), |i, _| *i, pass), Err("draw"));
        let drawn = AtomicUsize::new(0);
        let draw = |i: usize| {
            drawn.fetch_add(1, Ordering::SeqCst);
            Ok(i)
        };
        let full = |i: usize, _: usize| if i == 3 { Err("full") } else { Ok(()) };
        assert_eq!(overlap(10_000, draw, |i, _| *i, full), Err("full"));
        assert!(drawn.into_inner() < 1000);
    }

    #[test]
    fn one_thread_suffices_even_when_it_is_the_callers() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let mut sum = 0;
        let add = |_: usize, i: usize| {
            sum += i;
            Ok::<_, ()>(())
        };
        pool.install(|| overlap(50, Ok, |i, _| *i, add)).unwrap();
        assert_eq!(sum, 49 * 50 / 2);
    }
}
