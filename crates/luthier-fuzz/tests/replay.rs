//! The corpus, as it is and changed at random: no panic, no hang, no memory without bound.
//!
//! `LUTHIER_FUZZ_CASES` sets the changed inputs of a target.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use luthier_fuzz::{Input, TARGETS, Target, corpus};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestRunner;

/// Changed inputs of each target: all of them take a few seconds.
const CASES: u32 = 1000;

/// Most processor time of one input: a hundred times what the slowest takes.
const TIME_MAX: Duration = Duration::from_secs(20);

/// One input at a time, because the limit on memory is that of the program.
static ALONE: Mutex<()> = Mutex::new(());

fn feed(target: &Target, bytes: &[u8]) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let before = used();
    (target.run)(bytes);
    let took = used().saturating_sub(before);
    assert!(took < TIME_MAX, "{} took {took:?}", target.name);
}

/// Processor time of this thread so far, which does not grow while others have the processor: Linux' count of nanoseconds, elsewhere zero.
fn used() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    Duration::from_nanos(text.split(' ').next().and_then(|count| count.parse().ok()).unwrap_or(0))
}

fn inputs(target: &Target) -> Vec<Input> {
    corpus(target).unwrap()
}

#[test]
fn the_corpus_holds() {
    for target in &TARGETS {
        let inputs = inputs(target);
        assert!(inputs.len() >= 2, "{}: {} inputs", target.name, inputs.len());
        for input in inputs {
            eprintln!("{}", input.path.display());
            feed(target, &input.bytes);
        }
    }
}

#[test]
fn the_corpus_is_small() {
    let own = |target: &Target| {
        let folder = &luthier_fuzz::folders(target)[0];
        inputs(target)
            .iter()
            .filter(|input| input.path.starts_with(folder))
            .map(|input| input.bytes.len())
            .sum::<usize>()
    };
    let sum: usize = TARGETS.iter().map(own).sum();
    assert!(sum < 310_000, "{sum} bytes");
}

/// A change of an input.
#[derive(Debug, Clone)]
enum Edit {
    Flip(Index, u8),
    Number(Index, Vec<u8>),
    Insert(Index, Vec<u8>),
    Remove(Index, usize),
    Double(Index, usize),
    Cut(Index),
    Graft(Index, Index, Index, usize),
}

/// Numbers at which sizes and offsets break, in both byte orders, and pieces of texts.
fn pieces() -> Vec<Vec<u8>> {
    let words = [0u32, 1, 0x7fff, 0xffff, 0x0100_0000, 0x7fff_ffff, 0x8000_0000, 0xffff_fff0, 0xffff_ffff, 0x7fc0_0000];
    let longs = [0u64, 1 << 31, 1 << 32, u64::MAX >> 1, u64::MAX - 7, u64::MAX];
    let texts = [
        "\n",
        "0",
        "-1",
        "1e400",
        "nan",
        "inf",
        "\"",
        "[",
        "]",
        "{",
        "}",
        "null",
        "é",
        "\0",
        "\r\n",
        ",",
        "=",
        "18446744073709551616",
    ];
    let words = words.iter().flat_map(|word| [word.to_le_bytes().to_vec(), word.to_be_bytes().to_vec()]);
    let longs = longs.iter().map(|long| long.to_le_bytes().to_vec());
    words.chain(longs).chain(texts.iter().map(|text| text.as_bytes().to_vec())).collect()
}

fn edit() -> impl Strategy<Value = Edit> {
    let piece = || prop::sample::select(pieces());
    prop_oneof![
        4 => (any::<Index>(), 1u8..).prop_map(|(at, bits)| Edit::Flip(at, bits)),
        4 => (any::<Index>(), piece()).prop_map(|(at, piece)| Edit::Number(at, piece)),
        2 => (any::<Index>(), piece()).prop_map(|(at, piece)| Edit::Insert(at, piece)),
        2 => (any::<Index>(), 1usize..40).prop_map(|(at, length)| Edit::Remove(at, length)),
        1 => (any::<Index>(), 1usize..200).prop_map(|(at, length)| Edit::Double(at, length)),
        1 => any::<Index>().prop_map(Edit::Cut),
        2 => (any::<Index>(), any::<Index>(), any::<Index>(), 1usize..200)
            .prop_map(|(at, input, from, length)| Edit::Graft(at, input, from, length)),
    ]
}

fn change(bytes: &mut Vec<u8>, edit: &Edit, inputs: &[Input]) {
    let place = |at: &Index| at.index(bytes.len() + 1);
    match edit {
        Edit::Flip(at, bits) => {
            let place = place(at);
            bytes.get_mut(place).into_iter().for_each(|byte| *byte ^= bits);
        }
        Edit::Number(at, piece) => {
            let place = place(at);
            bytes.iter_mut().skip(place).zip(piece).for_each(|(byte, new)| *byte = *new);
        }
        Edit::Insert(at, piece) => {
            let place = place(at);
            bytes.splice(place..place, piece.iter().copied());
        }
        Edit::Remove(at, length) => {
            let place = place(at);
            bytes.drain(place..bytes.len().min(place + length));
        }
        Edit::Double(at, length) => {
            let place = place(at);
            bytes.extend_from_within(place..bytes.len().min(place + length));
        }
        Edit::Cut(at) => bytes.truncate(place(at)),
        Edit::Graft(at, input, from, length) => {
            let (place, other) = (place(at), &inputs[input.index(inputs.len())].bytes);
            let from = from.index(other.len() + 1);
            let part = other[from..other.len().min(from + length)].to_vec();
            bytes.splice(place..place, part);
        }
    }
}

fn changed(name: &str) {
    let target = luthier_fuzz::target(name).unwrap();
    let inputs = inputs(target);
    let cases = std::env::var("LUTHIER_FUZZ_CASES").map_or(CASES, |cases| cases.parse().unwrap());
    let mut runner = TestRunner::new(ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() });
    let case = (any::<Index>(), prop::collection::vec(edit(), 1..6));
    let outcome = runner.run(&case, |(which, edits)| {
        let mut bytes = inputs[which.index(inputs.len())].bytes.clone();
        edits.iter().for_each(|edit| change(&mut bytes, edit, &inputs));
        feed(target, &bytes);
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("{name}: {error}");
    }
}

macro_rules! tests_of_targets {
    ($($name:ident),*) => {
        mod changed_inputs_of {
            $(#[test]
            fn $name() {
                super::changed(stringify!($name));
            })*
        }

        /// A new target has a test.
        #[test]
        fn every_target_is_changed() {
            assert_eq!(TARGETS.map(|target| target.name), [$(stringify!($name)),*]);
        }
    };
}

tests_of_targets!(
    material,
    scene,
    index,
    page,
    axes,
    directions,
    lobe,
    reradiation,
    lock,
    manifest,
    report,
    stability,
    costs,
    ktx2,
    exr,
    png,
    picture,
    radiance,
    gltf,
    import,
    table,
    raw
);
