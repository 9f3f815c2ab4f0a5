//! The sections of nodes and elements in versions 2.0 to 2.2.

use super::super::error::{ErrorKind, Fault};
use super::super::source::Source;
use super::{Binary, Encoding, Mesh, binary_shape, text_point, text_shape};

/// Reads a line that holds one count.
fn count(source: &mut Source<'_>, expected: &'static str) -> Result<u64, Fault> {
    let mut line = source.need_content(None, expected)?;
    let count = line.integer(expected)?;
    line.end()?;
    Ok(count)
}

/// Reads the nodes, up to the line that ends the section.
pub(super) fn nodes(source: &mut Source<'_>, encoding: Encoding, mesh: &mut Mesh) -> Result<(), Fault> {
    const EXPECTED: &str = "as many nodes as the section says";
    for _ in 0..count(source, "the number of nodes")? {
        match encoding {
            Encoding::Text => {
                let mut line = source.need_content(None, EXPECTED)?;
                let word = line.need_word("the tag of the node")?;
                if !mesh.nodes.push(line.parse_integer(word, "the tag of the node")?) {
                    return Err(line.fault(word.at, ErrorKind::TooManyVertices));
                }
                mesh.points.extend(text_point(&mut line)?);
                line.end()?;
            }
            Encoding::Binary { big_endian } => {
                let binary = Binary { big_endian };
                if !mesh.nodes.push(binary.count(source, EXPECTED)?) {
                    return Err(Fault::new(source.byte(), ErrorKind::TooManyVertices));
                }
                mesh.points.extend(binary.point(source, mesh.intake.on_bad)?);
            }
        }
    }
    Ok(())
}

/// Reads the elements, up to the line that ends the section.
pub(super) fn elements(source: &mut Source<'_>, encoding: Encoding, mesh: &mut Mesh) -> Result<(), Fault> {
    let count = count(source, "the number of elements")?;
    match encoding {
        Encoding::Text => text_elements(source, count, mesh),
        Encoding::Binary { big_endian } => binary_elements(source, Binary { big_endian }, count, mesh),
    }
}

fn text_elements(source: &mut Source<'_>, count: u64, mesh: &mut Mesh) -> Result<(), Fault> {
    for _ in 0..count {
        let mut line = source.need_content(None, "as many elements as the section says")?;
        let start = line.need_word("the tag of the element")?;
        let tag: i64 = line.parse_integer(start, "the tag of the element")?;
        let number = line.need_word("the type of the element")?;
        let shape = text_shape(&line, number)?;
        let mut group = 0;
        for place in 0..line.integer::<u64>("the number of tags")? {
            let word = line.need_word("a tag")?;
            if place == 0 {
                group = line.parse_integer(word, "the number of a physical group")?;
            }
        }
        mesh.begin_element(tag.cast_unsigned(), group);
        mesh.text_element(&mut line, start.at, shape)?;
    }
    Ok(())
}

fn binary_elements(source: &mut Source<'_>, binary: Binary, count: u64, mesh: &mut Mesh) -> Result<(), Fault> {
    const EXPECTED: &str = "as many elements as the section says";
    let mut read = 0;
    while read < count {
        let shape = binary_shape(source, binary, EXPECTED)?;
        let position = source.byte();
        let follow = binary.count(source, "the number of elements of this type that follow")?;
        if follow == 0 || follow > count - read {
            let kind = ErrorKind::WrongCount { what: "elements", declared: count, found: read + follow };
            return Err(Fault::new(position, kind));
        }
        let tags = binary.count(source, "the number of tags")?;
        for _ in 0..follow {
            let start = source.byte();
            let tag = binary.int(source, EXPECTED)?;
            let group = if tags > 0 { binary.int(source, EXPECTED)? } else { 0 };
            source.skip(4 * tags.saturating_sub(1), EXPECTED)?;
            mesh.begin_element(i64::from(tag).cast_unsigned(), group.into());
            mesh.word.clear();
            for _ in 0..shape.num_nodes {
                let position = source.byte();
                let tag = binary.count(source, EXPECTED)?;
                let node = mesh.node(tag, || position)?;
                mesh.word.push(node);
            }
            mesh.element(shape).map_err(|kind| Fault::new(start, kind))?;
        }
        read += follow;
    }
    Ok(())
}
