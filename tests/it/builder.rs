//! The builder and Algorithms 1 to 3 against the oracle's file: the same bytes, for any order of the input.

use proptest::prelude::*;
use sig_core::format::{Column, Encoder, Kind, Section, SectionKind};
use sig_core::{Index, IndexWidth};
use sig_tests::aligned::AlignedBytes;
use sig_tests::encode::{Options, encode};
use sig_tests::known;
use sig_tests::oracle::{Oracle, Word};
use sig_tests::strategies;
use sig_tools::build::{BuildOptions, build};
use sig_tools::incidence_graph::IncidenceGraph;
use sig_tools::soup::{Labels, Soup};
