#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/polygon_mesh.h>

#include <string>
#include <string_view>
#include <vector>

/// Surface meshes from OFF, PLY, OBJ and STL.
///
/// A file is either read completely or refused; nothing is repaired, merged, reordered or dropped, but where
/// a format below says so.
/// What the mesh is like (holes, duplicates, zero area, ...) is the business of inspect() in inspect.h.
///
/// Refused with InvalidInput, whose place is "name:line" (text, first line 1) or "name:byte N" (binary, first
/// byte 0): a number that is not finite or not a number; an index that is negative, fractional or not below
/// the number of vertices; a face of fewer than three corners; data that is missing or left over; a header
/// that contradicts itself. A face that names a vertex twice is accepted.
///
/// With `notes`, geometry is read wherever it is beyond doubt, and each liberty is told with its place;
/// without them nobody would be told, and all of it is refused:
/// - colors, normals and texture coordinates with a value that is none: dropped;
/// - OFF: more faces than the header counts: kept; normals and colors under a plain OFF, and before each
///   other under NCOFF, where all lines agree and the values tell which they are; a count glued to the
///   keyword; a negative count of edges; binary little-endian, and binary without the counts of color values;
/// - PLY: header lines that begin with an unknown word; values in a text line beyond the declared ones (and
///   then the colors and normals there are dropped); bytes after the end; LF CR at the end of lines;
/// - OBJ: lines that begin with an unknown word; STL: bytes after the end.
/// What OBJ and STL hold beyond a mesh, as said below, is told too, and never refused.
///
/// Time is linear in the bytes. Memory is bounded by the bytes present: counts in a header reserve no more
/// than the rest of the file could fill. The result depends neither on the locale nor on the machine's byte
/// order.
namespace tendril::bind {

/// Reads a file. The format is recognised by its bytes, and by its name (.obj, .stl) only where they do not
/// tell. Throws FileError when it cannot be read, InvalidInput when it is none of the four or malformed.
/// \param path   a regular file
/// \param notes  where remarks are appended; null: none are made
TENDRIL_BIND_API PolygonMesh read_mesh(const std::string& path, std::vector<std::string>* notes = nullptr);

/// OFF [Geomview], section "OFF files" of its manual: text or binary (big-endian), the keyword required, '#'
/// comments.
/// - Prefixes N (normals), C (colors) and ST (texture coordinates); each vertex holds point, normal, color,
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
/// - Used: vertex x y z, nx ny nz, red green blue alpha, and s t, u v or texture_u texture_v; face
///   vertex_indices or vertex_index, texcoord (a list of two numbers a corner), red green blue alpha.
/// - Elements stand in any order; other elements and properties are skipped. Colors of floating type are
///   0..1, of integer type 0..255.
/// - In text, elements begin on a line of their own.
/// - In place of faces, tristrips vertex_indices: strips of triangles, -1 between them.
/// \param bytes  the whole file
/// \param name   stands for the file in errors
TENDRIL_BIND_API PolygonMesh parse_ply(std::string_view bytes, const std::string& name);

/// Wavefront OBJ [Alias 1992], its polygons: v, vn, vt, f; '#' comments, a backslash that stands alone at the
/// end of a line continues it.
/// - v: x y z, then nothing, a weight (not used), or a color of 3 or 4 numbers: 0..1, or 0..255 where one of
///   them exceeds 1.
/// - f: corners v, v/vt, v//vn, v/vt/vn, counted from 1, or from -1 backwards from the line; also of lines to
///   come.
/// - Normals are kept where each point has one. Texture coordinates are the points' where each has one pair,
///   else the corners'; a third number is not used, and corners without get 0 0 where others have some.
/// - Passed over: names, groups, materials; points, lines, free-form curves and surfaces.
/// - It has no counts: a file cut at the end of a line is a smaller mesh. One without a vertex is refused.
/// \param bytes  the whole file
/// \param name   stands for the file in errors
TENDRIL_BIND_API PolygonMesh parse_obj(std::string_view bytes, const std::string& name);

/// STL [3D Systems 1989]: text, of one or several solids, or binary, which is told by its size even where it
/// begins with "solid".
/// - Corners at exactly the same place (0 equals -0) become one point; points are in the order in which they
///   first appear.
/// - Stored normals are not used, nor are attribute bytes; facets whose normal points against the order of
///   their corners, and those with two corners at one place, are kept.
/// \param bytes  the whole file
/// \param name   stands for the file in errors
TENDRIL_BIND_API PolygonMesh parse_stl(std::string_view bytes, const std::string& name);

}  // namespace tendril::bind
