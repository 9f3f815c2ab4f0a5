//! The sections of nodes and elements in version 4.1: blocks, one an entity of the geometry.

use super::super::error::{ErrorKind, Fault};
use super::super::source::Source;
use super::{Binary, Encoding, Mesh, binary_shape, text_point, text_shape};

/// What begins a section: the numbers of blocks and of nodes or elements in all.
struct Totals {
    blocks: u64,
    items: u64,
}

fn totals(source: &mut Source<'_>, encoding: Encoding, size: usize) -> Result<Totals, Fault> {
    const EXPECTED: &str = "the numbers of blocks and items, the least and the greatest tag";
    let numbers = match encoding {
        Encoding::Text => {
            let mut line = source.need_content(None, EXPECTED)?;
            let mut numbers = [0; 4];
            for number in &mut numbers {
                *number = line.integer(EXPECTED)?;
            }
            line.end()?;
            numbers
        }
        Encoding::Binary { big_endian } => {
            let mut numbers = [0; 4];
            for number in &mut numbers {
                *number = Binary { big_endian }.size(source, size, EXPECTED)?;
            }
            numbers
        }
    };
    Ok(Totals { blocks: numbers[0], items: numbers[1] })
}

/// Compares the number of items found with the declared one, at the end of a section.
fn check(source: &Source<'_>, what: &'static str, declared: u64, found: u64) -> Result<(), Fault> {
    if declared == found {
        return Ok(());
    }
    Err(Fault::new(source.end_of_text(), ErrorKind::WrongCount { what, declared, found }))
}

/// Reads the nodes, up to the line that ends the section.
pub(super) fn nodes(source: &mut Source<'_>, encoding: Encoding, size: usize, mesh: &mut Mesh) -> Result<(), Fault> {
    let totals = totals(source, encoding, size)?;
    for _ in 0..totals.blocks {
        match encoding {
            Encoding::Text => text_node_block(source, mesh)?,
            Encoding::Binary { big_endian } => binary_node_block(source, Binary { big_endian }, size, mesh)?,
        }
    }
    check(source, "nodes", totals.items, mesh.nodes.len() as u64)
}

fn text_node_block(source: &mut Source<'_>, mesh: &mut Mesh) -> Result<(), Fault> {
    let mut line = source.need_content(None, "as many blocks of nodes as the section says")?;
    line.integer::<i32>("the dimension of the entity")?;
    line.integer::<i32>("the tag of the entity")?;
    line.integer::<u8>("0, or 1 for parametric coordinates")?;
    let count: u64 = line.integer("the number of nodes in the block")?;
    line.end()?;
    // Tags stand one a line as a rule, but nothing forbids several.
    let mut read = 0;
    while read < count {
        let mut line = source.need_content(None, "as many node tags as the block says")?;
        while line.skip_blanks() {
            if read == count {
                return Err(line.trailing("tags of the block"));
            }
            let at = line.at();
            if !mesh.nodes.push(line.integer("a node tag")?) {
                return Err(line.fault(at, ErrorKind::TooManyVertices));
            }
            read += 1;
        }
    }
    for _ in 0..count {
        let mut line = source.need_content(None, "as many nodes as the block says")?;
        mesh.points.extend(text_point(&mut line)?);
        // Parametric coordinates may follow.
        while line.skip_blanks() {
            line.float::<f64>("a parametric coordinate")?;
        }
    }
    Ok(())
}

fn binary_node_block(source: &mut Source<'_>, binary: Binary, size: usize, mesh: &mut Mesh) -> Result<(), Fault> {
    const EXPECTED: &str = "as many blocks of nodes as the section says";
    let dim = binary.count(source, "the dimension of the entity")?;
    binary.int(source, EXPECTED)?;
    let parametric = binary.int(source, EXPECTED)? != 0;
    let count = binary.size(source, size, EXPECTED)?;
    for _ in 0..count {
        let position = source.byte();
        if !mesh.nodes.push(binary.size(source, size, "as many node tags as the block says")?) {
            return Err(Fault::new(position, ErrorKind::TooManyVertices));
        }
    }
    for _ in 0..count {
        mesh.points.extend(binary.point(source, mesh.intake.on_bad)?);
        if parametric {
            source.skip(8 * dim.min(3), "the parametric coordinates of the node")?;
        }
    }
    Ok(())
}

/// Reads the elements, up to the line that ends the section.
pub(super) fn elements(source: &mut Source<'_>, encoding: Encoding, size: usize, mesh: &mut Mesh) -> Result<(), Fault> {
    let totals = totals(source, encoding, size)?;
    let mut read = 0u64;
    for _ in 0..totals.blocks {
        read += match encoding {
            Encoding::Text => text_element_block(source, mesh)?,
            Encoding::Binary { big_endian } => binary_element_block(source, Binary { big_endian }, size, mesh)?,
        };
    }
    check(source, "elements", totals.items, read)
}

/// Reads a block; gives the number of its elements.
fn text_element_block(source: &mut Source<'_>, mesh: &mut Mesh) -> Result<u64, Fault> {
    let mut line = source.need_content(None, "as many blocks of elements as the section says")?;
    let dim = line.integer("the dimension of the entity")?;
    let entity = line.integer("the tag of the entity")?;
    let group = mesh.groups.of(dim, entity);
    let number = line.need_word("the type of the elements")?;
    let shape = text_shape(&line, number)?;
    let count = line.integer("the number of elements in the block")?;
    line.end()?;
    for _ in 0..count {
        let mut line = source.need_content(None, "as many elements as the block says")?;
        let start = line.need_word("the tag of the element")?;
        let tag: i64 = line.parse_integer(start, "the tag of the element")?;
        mesh.begin_element(tag.cast_unsigned(), group);
        mesh.text_element(&mut line, start.at, shape)?;
    }
    Ok(count)
}

/// Reads a block; gives the number of its elements.
fn binary_element_block(source: &mut Source<'_>, binary: Binary, size: usize, mesh: &mut Mesh) -> Result<u64, Fault> {
    const EXPECTED: &str = "as many blocks of elements as the section says";
    let (dim, entity) = (binary.int(source, EXPECTED)?, binary.int(source, EXPECTED)?);
    let group = mesh.groups.of(dim, entity);
    let shape = binary_shape(source, binary, EXPECTED)?;
    let count = binary.size(source, size, EXPECTED)?;
    for _ in 0..count {
        let start = source.byte();
        let tag = binary.size(source, size, "as many elements as the block says")?;
        mesh.begin_element(tag, group);
        mesh.word.clear();
        for _ in 0..shape.num_nodes {
            let position = source.byte();
            let tag = binary.size(source, size, "as many node tags as the type of the element asks for")?;
            let node = mesh.node(tag, || position)?;
            mesh.word.push(node);
        }
        mesh.element(shape).map_err(|kind| Fault::new(start, kind))?;
    }
    Ok(count)
}
