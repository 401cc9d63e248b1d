// A model simplified by OpenSceneGraph's osgUtil::Simplifier, for tests/bench/simplify.sh,
// which builds it where the library is there (`pkg-config openscenegraph-osgUtil`).
//
// Usage: bench_osg_simplify FOLDER PERCENT...
// Reads FOLDER/base.obj as bench_simplify writes it (one index for the three numbers of a
// corner); writes FOLDER/osg-PERCENT.obj, prints lines of METHOD,PERCENT,TARGET,TRIANGLES,MS.
// Each material is a geometry of its own, as OpenSceneGraph's readers make them.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <osg/Geometry>
#include <osg/TriangleIndexFunctor>
#include <osgUtil/Simplifier>
#include <sstream>
#include <string>
#include <vector>

namespace
{

struct Part {
    std::string material;
    std::vector<unsigned> indices;
};

struct Mesh {
    std::string library;
    std::vector<osg::Vec3> positions, normals;
    std::vector<osg::Vec2> uvs;
    std::vector<Part> parts;
};

struct Triangles {
    std::vector<unsigned> indices;
    void operator()(unsigned a, unsigned b, unsigned c)
    {
        indices.insert(indices.end(), {a, b, c});
    }
};

Mesh read(const std::string &path)
{
    std::ifstream in(path);
    Mesh mesh;
    std::string line, word;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        float x = 0, y = 0, z = 0;
        words >> word;
        if (word == "mtllib") mesh.library = line;
        if (word == "usemtl") mesh.parts.push_back({line, {}});
        if (word == "f")
            while (words >> word)
                mesh.parts.back().indices.push_back(
                    unsigned(std::strtoul(word.c_str(), nullptr, 10)) - 1);
        else
            words >> x >> y >> z;
        if (word == "v") mesh.positions.emplace_back(x, y, z);
        if (word == "vt") mesh.uvs.emplace_back(x, y);
        if (word == "vn") mesh.normals.emplace_back(x, y, z);
    }
    return mesh;
}

// The part alone, its vertices numbered anew.
osg::ref_ptr<osg::Geometry> geometry_of(const Mesh &mesh, const Part &part)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> uvs = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    std::map<unsigned, unsigned> numbers;
    for (unsigned index : part.indices) {
        auto [at, fresh] = numbers.emplace(index, unsigned(numbers.size()));
        if (fresh) {
            positions->push_back(mesh.positions[index]);
            normals->push_back(mesh.normals[index]);
            uvs->push_back(mesh.uvs[index]);
        }
        elements->push_back(at->second);
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, uvs, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(elements);
    return geometry;
}

// Returns the triangles written.
size_t append(std::FILE *out, const osg::Geometry &geometry, unsigned &base)
{
    const auto &positions = dynamic_cast<const osg::Vec3Array &>(*geometry.getVertexArray());
    const auto &normals = dynamic_cast<const osg::Vec3Array &>(*geometry.getNormalArray());
    const auto &uvs = dynamic_cast<const osg::Vec2Array &>(*geometry.getTexCoordArray(0));
    for (size_t i = 0; i < positions.size(); i++)
        std::fprintf(out, "v %.9g %.9g %.9g\nvt %.9g %.9g\nvn %.5g %.5g %.5g\n",
                     double(positions[i].x()), double(positions[i].y()),
                     double(positions[i].z()), double(uvs[i].x()), double(uvs[i].y()),
                     double(normals[i].x()), double(normals[i].y()), double(normals[i].z()));
    osg::TriangleIndexFunctor<Triangles> triangles;
    geometry.accept(triangles);
    const auto &t = triangles.indices;
    for (size_t i = 0; i < t.size(); i += 3) {
        const unsigned a = base + t[i], b = base + t[i + 1], c = base + t[i + 2];
        std::fprintf(out, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c);
    }
    base += unsigned(positions.size());
    return t.size() / 3;
}

void measure(const Mesh &mesh, const std::string &folder, const char *percent)
{
    const double ratio = std::atof(percent) / 100;
    std::FILE *out = std::fopen((folder + "/osg-" + percent + ".obj").c_str(), "w");
    if (!out) std::exit(4);
    std::fprintf(out, "%s\n", mesh.library.c_str());
    size_t before = 0, after = 0;
    unsigned base = 1;
    double ms = 0;
    for (const Part &part : mesh.parts) {
        osg::ref_ptr<osg::Geometry> geometry = geometry_of(mesh, part);
        osgUtil::Simplifier simplifier(ratio);
        simplifier.setSmoothing(false); // normals stay the mesh's own
        simplifier.setDoTriStrip(false);
        const auto start = std::chrono::steady_clock::now();
        simplifier.simplify(*geometry);
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        ms += took.count();
        std::fprintf(out, "%s\n", part.material.c_str());
        before += part.indices.size() / 3;
        after += append(out, *geometry, base);
    }
    std::fclose(out);
    std::printf("osg,%s,%.0f,%zu,%.3f\n", percent, std::round(ratio * double(before)), after,
                ms);
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv)
{
    if (argc < 3) {
        std::fputs("Usage: bench_osg_simplify FOLDER PERCENT...\n", stderr);
        return 1;
    }
    const Mesh mesh = read(std::string(argv[1]) + "/base.obj");
    for (int i = 2; i < argc; i++) measure(mesh, argv[1], argv[i]);
    return 0;
}
