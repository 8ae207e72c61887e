#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/polygon_mesh.h>

#include <string>
#include <string_view>
#include <vector>

/// Surface meshes from OFF and PLY.
///
/// A file is either read completely or refused; nothing is repaired, merged, reordered or dropped.
/// What the mesh is like (holes, duplicates, zero area, ...) is the business of inspect() in inspect.h.
///
/// Refused with InvalidInput, whose place is "name:line" (text, first line 1) or "name:byte N" (binary, first
/// byte 0): a number that is not finite or not a number; an index that is negative, fractional or not below
/// the number of vertices; a face of fewer than three corners; data that is missing or left over; a header
/// that contradicts itself. A face that names a vertex twice is accepted.
///
/// With `notes`, geometry is read wherever it is beyond doubt, and each liberty is told with its place;
/// without them nobody would be told, and all of it is refused:
/// - colors and normals with a value that is none: dropped;
/// - OFF: more faces than the header counts: kept; normals and colors under a plain OFF, and before each
///   other under NCOFF, where all lines agree and the values tell which they are; a count glued to the
///   keyword; a negative count of edges; binary little-endian, and binary without the counts of color values;
/// - PLY: header lines that begin with an unknown word; values in a text line beyond the declared ones (and
///   then the colors and normals there are dropped); bytes after the end; LF CR at the end of lines.
///
/// Time is linear in the bytes. Memory is bounded by the bytes present: counts in a header reserve no more
/// than the rest of the file could fill. The result depends neither on the locale nor on the machine's byte
/// order.
namespace tendril::bind {

/// Reads a file. The format is recognised by its first bytes, not by its name.
/// Throws FileError when it cannot be read, InvalidInput when it is neither OFF nor PLY or malformed.
/// \param path   a regular file
/// \param notes  where remarks are appended; null: none are made
TENDRIL_BIND_API PolygonMesh read_mesh(const std::string& path, std::vector<std::string>* notes = nullptr);

/// OFF [Geomview], section "OFF files" of its manual: text or binary (big-endian), the keyword required, '#'
/// comments.
/// - Prefixes N (normals), C (colors) and ST (texture, dropped); each vertex holds point, normal, color,
///   texture in this order. 4OFF and nOFF are refused: their points are not points of space.
/// - Colors are 3 or 4 numbers; a color without alpha is opaque. They are 0..255 when all vertices' (or all
///   faces') are whole numbers or one exceeds 1, else 0..1; alpha has its own range. A face color of one
///   number is an index into a palette that is not in the file: it is read and dropped. Faces without a color
///   among faces that have one get Geomview's default, grey 0.666.
/// - In text, what follows a vertex's color or a face's corners ends with the line; the rest is free-form.
/// \param bytes  the whole file
/// \param name   stands for the file in errors
TENDRIL_BIND_API PolygonMesh parse_off(std::string_view bytes, const std::string& name);

/// PLY 1.0 [Turk 1994]: ascii, binary_little_endian, binary_big_endian.
/// - Scalar types char .. double, their sized names int8 .. float64, and int64/uint64. Text is read in double
///   precision whatever floating type the header gives.
/// - Used: vertex x y z, nx ny nz, red green blue alpha; face vertex_indices or vertex_index, red green blue
///   alpha. Elements stand in any order; other elements and properties are skipped. Colors of floating type
///   are 0..1, of integer type 0..255.
/// - In text, elements begin on a line of their own.
/// - In place of faces, tristrips vertex_indices: strips of triangles, -1 between them.
/// \param bytes  the whole file
/// \param name   stands for the file in errors
TENDRIL_BIND_API PolygonMesh parse_ply(std::string_view bytes, const std::string& name);

}  // namespace tendril::bind
