//! The page: three files of ours and nothing from elsewhere, so that it works without any other network.

use axum::http::header::{CONTENT_TYPE, HeaderName};

type File = ([(HeaderName, &'static str); 1], &'static str);

const fn file(kind: &'static str, text: &'static str) -> File {
    ([(CONTENT_TYPE, kind)], text)
}

pub const HTML: File = file("text/html; charset=utf-8", include_str!("page.html"));
pub const CSS: File = file("text/css; charset=utf-8", include_str!("page.css"));
pub const JS: File = file("text/javascript; charset=utf-8", include_str!("page.js"));
