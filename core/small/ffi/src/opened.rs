//! An open complex, of one of the widths that this library was built with.

use sig_core::format::{Container, Kind};
use sig_core::{Complex, IndexWidth};

use crate::Status;

/// As [`AnyComplex`](sig_core::AnyComplex), without the widths that were left out.
#[derive(Clone, Copy)]
pub(crate) enum Opened {
    #[cfg(feature = "bits-16")]
    Bits16(Complex<'static, u16>),
    #[cfg(feature = "bits-32")]
    Bits32(Complex<'static, u32>),
    #[cfg(feature = "bits-64")]
    Bits64(Complex<'static, u64>),
}

/// Evaluates an expression with the complex of an [`Opened`], whatever its width.
macro_rules! with_opened {
    ($opened:expr, $complex:ident => $body:expr) => {
        match $opened {
            #[cfg(feature = "bits-16")]
            $crate::opened::Opened::Bits16($complex) => $body,
            #[cfg(feature = "bits-32")]
            $crate::opened::Opened::Bits32($complex) => $body,
            #[cfg(feature = "bits-64")]
            $crate::opened::Opened::Bits64($complex) => $body,
        }
    };
}
pub(crate) use with_opened;

impl Opened {
    pub(crate) fn from_bytes(bytes: &'static [u8]) -> Result<Self, Status> {
        let container = Container::from_bytes(bytes)?;
        if container.header().kind != Kind::Sig {
            return Err(Status::Kind);
        }
        Ok(match container.header().width {
            #[cfg(feature = "bits-16")]
            IndexWidth::Bits16 => Self::Bits16(Complex::from_container(container)?),
            #[cfg(feature = "bits-32")]
            IndexWidth::Bits32 => Self::Bits32(Complex::from_container(container)?),
            #[cfg(feature = "bits-64")]
            IndexWidth::Bits64 => Self::Bits64(Complex::from_container(container)?),
            #[allow(unreachable_patterns, reason = "reached where a width was left out")]
            _ => return Err(Status::Width),
        })
    }
}
