use std::ffi::CStr;
use std::fmt;
use std::os::raw::c_char;

use crate::sys;

/// Why a call did nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// One of `sys::LKS_…`.
    pub status: i32,
    /// For people: "body.shape.radius: 0 m, must be 0.000977 … 512 m".
    pub message: String,
}

pub type Result<T> = std::result::Result<T, Error>;

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = text_of(unsafe { sys::lks_status_name(self.status) });
        if self.message.is_empty() || self.message == name {
            return write!(f, "{name}");
        }
        write!(f, "{name}: {}", self.message)
    }
}

impl std::error::Error for Error {}

impl Error {
    pub(crate) fn new(status: i32, message: &str) -> Self {
        Error { status, message: message.to_owned() }
    }
}

/// The result of a call, with the message of this thread.
pub(crate) fn check(status: sys::lks_status) -> Result<()> {
    if status == sys::LKS_OK {
        return Ok(());
    }
    let message = unsafe { CStr::from_ptr(sys::lks_last_error()) };
    Err(Error { status, message: message.to_string_lossy().into_owned() })
}

/// Text of the library that lives as long as the program.
pub(crate) fn text_of(text: *const c_char) -> &'static str {
    unsafe { CStr::from_ptr(text) }.to_str().unwrap_or("")
}

/// Text in an array of a structure.
pub(crate) fn text_in(array: &[c_char]) -> String {
    let bytes: Vec<u8> = array.iter().take_while(|&&c| c != 0).map(|&c| c as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Writes text into an array of a structure, cut to its room.
pub(crate) fn put_text(text: &str, array: &mut [c_char]) {
    let mut end = text.len().min(array.len() - 1);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    array.fill(0);
    for (to, from) in array.iter_mut().zip(text.as_bytes()[..end].iter()) {
        *to = *from as c_char;
    }
}

pub(crate) fn c_text(text: &str) -> Result<std::ffi::CString> {
    std::ffi::CString::new(text).map_err(|_| Error::new(sys::LKS_INVALID_ARGUMENT, "the text contains a zero"))
}

/// A structure that begins with its size, with the library's defaults: `definition!(Name, type, init)`.
macro_rules! definition {
    ($(#[$note:meta])* $name:ident, $raw:ident, $init:ident) => {
        $(#[$note])*
        #[derive(Clone, Copy)]
        pub struct $name(pub $crate::sys::$raw);

        impl Default for $name {
            fn default() -> Self {
                let mut raw: $crate::sys::$raw = unsafe { std::mem::zeroed() };
                let size = std::mem::size_of_val(&raw);
                let status = unsafe { $crate::sys::$init(&mut raw, size) };
                assert_eq!(status, $crate::sys::LKS_OK, "the library knows an older structure");
                $name(raw)
            }
        }

        impl std::ops::Deref for $name {
            type Target = $crate::sys::$raw;
            fn deref(&self) -> &Self::Target {
                &self.0
            }
        }

        impl std::ops::DerefMut for $name {
            fn deref_mut(&mut self) -> &mut Self::Target {
                &mut self.0
            }
        }
    };
}
pub(crate) use definition;

/// A zeroed structure that begins with its size.
macro_rules! sized {
    ($raw:ident) => {{
        let mut raw: $crate::sys::$raw = unsafe { std::mem::zeroed() };
        raw.size = std::mem::size_of_val(&raw) as u32;
        raw
    }};
}
pub(crate) use sized;
