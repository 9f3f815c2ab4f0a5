//! Memory for queries: too little is an error that says how much was needed and leaves nothing behind; a `static` one;
//! many threads.

use std::sync::Mutex;

use sig_core::{Complex, IndexWidth, ScratchError, SimplexId, StaticScratch, mark_words};
use sig_tests::conformance::{Memory, sorted};
use sig_tests::encode::{Options, encode};
use sig_tests::oracle::Oracle;

type Query = fn(&Complex<'_, u16>, SimplexId, &mut Memory<u16>) -> Result<Vec<usize>, ScratchError>;

/// Every query that takes a scratch.
const QUERIES: [(&str, Query); 8] = [
    ("coboundary to vertices' edges", |complex, id, memory| {
        Ok(sorted(complex.coboundary(id, 1, &mut memory.scratch())?))
    }),
    ("coboundary to tetrahedra", |complex, id, memory| Ok(sorted(complex.coboundary(id, 3, &mut memory.scratch())?))),
    ("star", |complex, id, memory| Ok(sorted(complex.star(id, &mut memory.scratch())?))),
    ("restricted star", |complex, id, memory| Ok(sorted(complex.restricted_star(id, &mut memory.scratch())?))),
    ("link", |complex, id, memory| Ok(sorted(complex.link(id, &mut memory.scratch())?))),
    ("adjacency", |complex, id, memory| Ok(sorted(complex.adjacency(id, &mut memory.scratch())?))),
    ("0-adjacency", |complex, id, memory| Ok(sorted(complex.k_adjacency(id, 0, &mut memory.scratch())?))),
    ("cluster", |complex, id, memory| {
        let Some(cluster) = complex.clusters(id).next() else { return Ok(Vec::new()) };
        Ok(sorted(complex.cluster_members(id, cluster.representative, &mut memory.scratch())?))
    }),
];

/// A cone over a ring of tetrahedra with things that dangle.
fn example() -> Oracle {
    Oracle::new(&[
        vec![0, 1, 2, 3],
        vec![0, 2, 3, 4],
        vec![0, 3, 4, 5],
        vec![0, 6, 7],
        vec![0, 7, 8],
        vec![0, 9],
        vec![3, 7],
        vec![10],
    ])
}

/// Grows what an error names, by as much as it says, until the query succeeds.
fn grow_until_answered(
    query: Query,
    complex: &Complex<'_, u16>,
    id: SimplexId,
    memory: &mut Memory<u16>,
) -> (Vec<usize>, usize) {
    for errors in 0..1000 {
        let error = match query(complex, id, memory) {
            Ok(answer) => return (answer, errors),
            Err(error) => error,
        };
        // A scratch clears the marks that it is given, so look at them before the next one is made.
        assert!(memory.marks.iter().all(|&word| word == 0), "marks left behind after: {error}");
        let (marks, queue, found) = (memory.marks.len(), memory.queue.len(), memory.found.len());
        *memory = match error {
            ScratchError::Marks { needed, available } => {
                assert_eq!((needed, available), (mark_words(complex.num_simplices()), marks));
                Memory::new(needed, queue, found)
            }
            ScratchError::Queue { at_least, available } => {
                assert!(available == queue && at_least > queue, "{error}");
                Memory::new(marks, at_least, found)
            }
            ScratchError::Found { at_least, available } => {
                assert!(available == found && at_least > found, "{error}");
                Memory::new(marks, queue, at_least)
            }
            other => panic!("{other}"),
        };
    }
    panic!("no end of errors");
}

#[test]
fn errors_lead_to_enough_memory() {
    let oracle = example();
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let mut roomy = Memory::roomy(oracle.len());
    for (name, query) in QUERIES {
        let mut errors = 0;
        for id in complex.simplices() {
            let mut memory = Memory::new(0, 0, 0);
            let (answer, failed) = grow_until_answered(query, &complex, id, &mut memory);
            assert_eq!(answer, query(&complex, id, &mut roomy).unwrap(), "{name} of {id}");
            errors += failed;
        }
        assert!(errors > oracle.len(), "{name}: the memory was never too small");
    }
}

/// One scratch through failures and successes: after an error the next answer is right.
#[test]
fn a_scratch_can_be_used_after_an_error() {
    let oracle = example();
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let (mut failed, mut answered) = (0, 0);
    for capacity in 1..30 {
        let mut memory = Memory::<u16>::new(mark_words(oracle.len()), capacity, capacity);
        let mut scratch = memory.scratch();
        for simplex in 0..oracle.len() {
            let id = SimplexId::new(simplex);
            for dim in 0..4 {
                match complex.coboundary(id, dim, &mut scratch) {
                    Ok(found) => assert_eq!(sorted(found), oracle.coboundary(simplex, dim)),
                    Err(_) => failed += 1,
                }
            }
            match complex.star(id, &mut scratch) {
                Ok(found) => assert_eq!(sorted(found), oracle.star(simplex)),
                Err(_) => failed += 1,
            }
            match complex.link(id, &mut scratch) {
                Ok(found) => assert_eq!(sorted(found), oracle.link(simplex)),
                Err(_) => failed += 1,
            }
            match complex.adjacency(id, &mut scratch) {
                Ok(found) => {
                    assert_eq!(sorted(found), oracle.adjacency(simplex));
                    answered += 1;
                }
                Err(_) => failed += 1,
            }
        }
    }
    assert!(failed > 500 && answered > 500, "{failed} failed, {answered} answered");
}

#[test]
fn breaking_out_of_an_answer_leaves_nothing_behind() {
    let oracle = example();
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let mut memory = Memory::<u16>::roomy(oracle.len());
    let mut scratch = memory.scratch();
    for simplex in 0..oracle.len() {
        let id = SimplexId::new(simplex);
        let _ = complex.star(id, &mut scratch).unwrap().next();
        let _ = complex.coboundary(id, 3, &mut scratch).unwrap().next();
        let _ = complex.link(id, &mut scratch).unwrap().nth(1);
        let _ = complex.adjacency(id, &mut scratch).unwrap();
        assert_eq!(sorted(complex.star(id, &mut scratch).unwrap()), oracle.star(simplex));
    }
    assert!(memory.marks.iter().all(|&word| word == 0));
}

/// A scratch over memory that holds anything.
#[test]
fn what_the_memory_held_does_not_matter() {
    let oracle = example();
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let mut memory = Memory::<u16>::roomy(oracle.len());
    memory.marks.fill(u32::MAX);
    memory.queue.fill(7);
    memory.masks.fill(u32::MAX);
    let mut scratch = memory.scratch();
    assert_eq!(sorted(complex.star(SimplexId::new(0), &mut scratch).unwrap()), oracle.star(0));
}

#[test]
fn a_static_scratch_behind_a_lock() {
    static MEMORY: Mutex<StaticScratch<u16, { mark_words(100) }, 100, 400>> = Mutex::new(StaticScratch::new());
    let oracle = example();
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    assert!(oracle.len() <= 100);
    for simplex in 0..oracle.len() {
        let mut memory = MEMORY.lock().unwrap();
        let mut scratch = memory.scratch();
        assert_eq!(sorted(complex.star(SimplexId::new(simplex), &mut scratch).unwrap()), oracle.star(simplex));
        let adjacent = complex.adjacency(SimplexId::new(simplex), &mut scratch).unwrap();
        assert_eq!(sorted(adjacent), oracle.adjacency(simplex));
    }
}

#[test]
fn a_static_scratch_too_small_says_so() {
    let oracle = example();
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    let complex = Complex::<u16>::from_bytes(&bytes).unwrap();
    let mut memory = StaticScratch::<u16, 1, 4, 4>::default();
    let needed = mark_words(oracle.len());
    let error = complex.star(SimplexId::new(0), &mut memory.scratch()).unwrap_err();
    assert_eq!(error, ScratchError::Marks { needed, available: 1 });
    assert_eq!(error.to_string(), format!("scratch too small: {needed} words of marks needed, 1 available"));
    let mut memory = StaticScratch::<u16, 4, 4, 4>::default();
    let error = complex.star(SimplexId::new(0), &mut memory.scratch()).unwrap_err();
    assert_eq!(error, ScratchError::Queue { at_least: 5, available: 4 });
}

#[test]
fn many_threads_ask_one_complex() {
    let oracle = example();
    let bytes = encode(&oracle, &Options { tree: true, ..Options::bare(IndexWidth::Bits32) });
    let complex = Complex::<u32>::from_bytes(&bytes).unwrap();
    let expected: Vec<_> = (0..oracle.len()).map(|id| (oracle.star(id), oracle.adjacency(id))).collect();
    std::thread::scope(|scope| {
        for thread in 0..8 {
            let expected = &expected;
            scope.spawn(move || {
                let mut memory = Memory::<u32>::roomy(expected.len());
                let mut scratch = memory.scratch();
                for round in 0..40 {
                    let simplex = (round * 7 + thread * 13) % expected.len();
                    let id = SimplexId::new(simplex);
                    let star = sorted(complex.star(id, &mut scratch).unwrap());
                    let adjacent = sorted(complex.adjacency(id, &mut scratch).unwrap());
                    assert_eq!((star, adjacent), expected[simplex]);
                }
            });
        }
    });
}
