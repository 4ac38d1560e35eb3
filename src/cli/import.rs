//! Imports a spur stage of a REXS model as a commented case.

use super::{Exit, Import, Streams, cases, new};
use std::io;

pub(super) fn run(options: &Import, streams: &mut Streams) -> io::Result<Exit> {
    let imported = match cases::read_model(&options.model, options.stage.as_deref(), streams) {
        Ok(imported) => imported,
        Err(exit) => return Ok(exit),
    };
    new::write(options.out.as_deref(), &imported.document.render(), streams)
}
