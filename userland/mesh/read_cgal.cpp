// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/read_cgal.hpp"

#include <iterator>
#include <stdexcept>
#include <tuple>

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/IO/read_ply_points.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/assertions_behaviour.h>
#include <boost/container/small_vector.hpp>

namespace phantom::mesh {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Points = std::vector<Kernel::Point_3>;

/// More corners than this are damage, not a polygon. Bounds what a false count can allocate.
constexpr std::size_t corners_max = 1 << 20;

/// A polygon as CGAL fills it; triangles and quadrilaterals need no memory of their own.
class Polygon : public boost::container::small_vector<std::uint32_t, 4> {
  public:
    void resize(std::size_t corners)
    {
        if (corners > corners_max)
            throw std::length_error("a polygon with more than 1048576 corners");
        small_vector::resize(corners);
    }
};
using Polygons = std::vector<Polygon>;

/// CGAL's failed assertions throw, but print first unless told not to.
class Quiet {
  public:
    Quiet() : error_(CGAL::set_error_handler(silent)), warning_(CGAL::set_warning_handler(silent)) {}
    ~Quiet()
    {
        CGAL::set_error_handler(error_);
        CGAL::set_warning_handler(warning_);
    }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

  private:
    static void silent(const char*, const char*, const char*, int, const char*) {}
    CGAL::Failure_function error_, warning_;
};

void take(const Points& points, const Polygons& polygons, PolygonSoup& out)
{
    out.vertices.reserve(points.size());
    for (const Kernel::Point_3& point : points)
        out.vertices.push_back({point.x(), point.y(), point.z()});
    out.first.reserve(polygons.size() + 1);
    out.corners.reserve(3 * polygons.size());
    for (const Polygon& polygon : polygons) {
        out.corners.insert(out.corners.end(), polygon.begin(), polygon.end());
        out.first.push_back(out.corners.size());
    }
}

void take_normals(const std::vector<Kernel::Vector_3>& normals, PolygonSoup& out)
{
    out.normals.reserve(normals.size());
    for (const Kernel::Vector_3& normal : normals)
        out.normals.push_back({normal.x(), normal.y(), normal.z()});
}

/// read_PLY gives no normals; the reader of point sets does, and stops after the vertices.
bool read_ply_normals(std::istream& stream, PolygonSoup& out)
{
    using Row = std::tuple<Kernel::Point_3, Kernel::Vector_3>;
    std::vector<Row> rows;
    if (!CGAL::IO::read_PLY_with_properties(
            stream, std::back_inserter(rows),
            CGAL::IO::make_ply_point_reader(CGAL::Nth_of_tuple_property_map<0, Row>()),
            CGAL::IO::make_ply_normal_reader(CGAL::Nth_of_tuple_property_map<1, Row>())))
        return false;
    std::vector<Kernel::Vector_3> normals;
    normals.reserve(rows.size());
    for (const Row& row : rows)
        normals.push_back(std::get<1>(row));
    take_normals(normals, out);
    return true;
}

} // namespace

bool cgal_read_ply(std::istream& stream, bool with_normals, PolygonSoup& out)
{
    const Quiet quiet;
    Points points;
    Polygons polygons;
    if (!CGAL::IO::read_PLY(stream, points, polygons, CGAL::parameters::verbose(false)))
        return false;
    take(points, polygons, out);
    if (!with_normals)
        return true;
    stream.clear();
    stream.seekg(0);
    return read_ply_normals(stream, out);
}

bool cgal_read_obj(std::istream& stream, PolygonSoup& out)
{
    const Quiet quiet;
    Points points;
    Polygons polygons;
    if (!CGAL::IO::read_OBJ(stream, points, polygons, CGAL::parameters::verbose(false)))
        return false;
    take(points, polygons, out);
    return true;
}

bool cgal_read_stl(std::istream& stream, PolygonSoup& out)
{
    const Quiet quiet;
    Points points;
    Polygons polygons;
    if (!CGAL::IO::read_STL(stream, points, polygons, CGAL::parameters::verbose(false)))
        return false;
    take(points, polygons, out);
    return true;
}

bool cgal_read_off(std::istream& stream, PolygonSoup& out)
{
    const Quiet quiet;
    Points points;
    Polygons polygons;
    std::vector<Kernel::Vector_3> normals;
    try {
        if (!CGAL::IO::read_OFF(
                stream, points, polygons,
                CGAL::parameters::verbose(false).vertex_normal_output_iterator(std::back_inserter(normals))))
            return false;
    } catch (const std::length_error&) {
        return false; // Polygon::resize: the stream stands behind the line of that face
    }
    take(points, polygons, out);
    take_normals(normals, out);
    return true;
}

} // namespace phantom::mesh
