//! Colours, strokes and marks of the pictures, light and dark; shapes and dashes distinguish series
//! without colour.

use crate::case::sanitize::sanitize;

/// The mark of each series.
pub(super) const LOOKS: [&str; 6] = [
    "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0Z",
    "M-4-4H4V4H-4Z",
    "M0-5.5L5.5 0L0 5.5L-5.5 0Z",
    "M0-5L5 4.5H-5Z",
    "M0 5L5-4.5H-5Z",
    "M-1.5-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5Z",
];

/// The style sheet of every picture. Its rules apply only to pictures, so that a page may contain
/// several.
pub(super) const STYLE: &str = "\
.tipstrike{font:15px 'DejaVu Sans',Helvetica,Arial,sans-serif;fill:#222}\
.tipstrike .title{font-size:17px;font-weight:bold}\
.tipstrike .ground{fill:#fff}\
.tipstrike .grid{stroke:#ddd;fill:none}\
.tipstrike .axis{stroke:#333;fill:none}\
.tipstrike .mark{stroke:#888;fill:none;stroke-dasharray:2 3}\
.tipstrike .curve{fill:none;stroke-width:2;stroke-linejoin:round}\
.tipstrike .thin{fill:none;stroke-opacity:.6}\
.tipstrike .bound{fill:none;stroke:#777;stroke-dasharray:1 3;stroke-width:1.5}\
.tipstrike .s0{stroke:#0b6e99}.tipstrike .f0{fill:#0b6e99}\
.tipstrike .s1{stroke:#b3261e;stroke-dasharray:9 3}.tipstrike .f1{fill:#b3261e}\
.tipstrike .s2{stroke:#2b7a3d;stroke-dasharray:3 2}.tipstrike .f2{fill:#2b7a3d}\
.tipstrike .s3{stroke:#8a4b08;stroke-dasharray:9 3 2 3}.tipstrike .f3{fill:#8a4b08}\
.tipstrike .s4{stroke:#6a3fa0;stroke-dasharray:14 4}.tipstrike .f4{fill:#6a3fa0}\
.tipstrike .s5{stroke:#555;stroke-dasharray:2 4}.tipstrike .f5{fill:#555}\
.tipstrike .thin{stroke-dasharray:none}\
.tipstrike .body1{fill:#d7e9f2;stroke:#0b6e99;stroke-width:1.5}\
.tipstrike .body2{fill:#f6e3d0;stroke:#8a4b08;stroke-width:1.5}\
.tipstrike .path{fill:none;stroke:#2b7a3d;stroke-width:2.5}\
.tipstrike .halo{paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}\
@media screen and (prefers-color-scheme:dark){\
.tipstrike{fill:#ddd}.tipstrike .ground{fill:#16181b}.tipstrike .grid{stroke:#33373c}\
.tipstrike .axis{stroke:#aaa}.tipstrike .path{stroke:#84d394}.tipstrike .bound{stroke:#999}.tipstrike .halo{stroke:#16181b}\
.tipstrike .s0{stroke:#62c3ee}.tipstrike .f0{fill:#62c3ee}\
.tipstrike .s1{stroke:#ff8a80}.tipstrike .f1{fill:#ff8a80}\
.tipstrike .s2{stroke:#84d394}.tipstrike .f2{fill:#84d394}\
.tipstrike .s3{stroke:#e8a862}.tipstrike .f3{fill:#e8a862}\
.tipstrike .s4{stroke:#c5a4f2}.tipstrike .f4{fill:#c5a4f2}\
.tipstrike .s5{stroke:#bbb}.tipstrike .f5{fill:#bbb}\
.tipstrike .body1{fill:#1d3642;stroke:#62c3ee}.tipstrike .body2{fill:#3f2d1a;stroke:#e8a862}}";

/// Escapes a text for an element or an attribute.
pub(crate) fn escaped(text: &str) -> String {
    sanitize(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
