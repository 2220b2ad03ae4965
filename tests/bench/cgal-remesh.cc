/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal-remesh FACTOR ITERATIONS <STREAM >STREAM: CGAL's tetrahedral_isotropic_remeshing
 * of a termesh stream with the boundary kept. The target edge length is the mean edge
 * length of the mesh times FACTOR. On standard error: the CPU seconds of the remeshing
 * alone, and of the whole process. Exit status 1 if the mesh cannot be read or built. */
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/File_medit.h>
#include <CGAL/Tetrahedral_remeshing/Remeshing_triangulation_3.h>
#include <CGAL/tetrahedral_remeshing.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Tetrahedral_remeshing::Remeshing_triangulation_3<Kernel>;

struct Mesh {
    std::vector<std::array<double, 3>> nodes;
    std::vector<std::array<std::size_t, 4>> tets; /* indices from 0 */
};

/* Skips lines up to that of a block and reads the number of its rows. */
bool find_block(std::istream &in, const std::string &name, std::size_t &rows)
{
    std::string line;
    while (std::getline(in, line))
        if (line == name)
            return std::getline(in, line) && std::istringstream(line) >> rows;
    return false;
}

/* Reads the blocks .node and .ele, which a filter writes in this order. */
bool read_mesh(std::istream &in, Mesh &mesh)
{
    std::string line;
    std::size_t rows, number, base = 0;
    if (!find_block(in, ".node", rows))
        return false;
    mesh.nodes.resize(rows);
    for (std::size_t v = 0; v < rows && std::getline(in, line); v++) {
        std::istringstream row(line);
        auto &xyz = mesh.nodes[v];
        row >> number >> xyz[0] >> xyz[1] >> xyz[2];
        if (v == 0)
            base = number;
    }
    if (!find_block(in, ".ele", rows))
        return false;
    mesh.tets.resize(rows);
    for (std::size_t t = 0; t < rows && std::getline(in, line); t++) {
        std::istringstream row(line);
        row >> number;
        for (auto &v : mesh.tets[t]) {
            row >> v;
            v -= base;
        }
    }
    return static_cast<bool>(in);
}

/* Builds the triangulation by way of the text that CGAL reads: the exterior becomes cells
 * at the infinite vertex. What CGAL reports on standard output goes nowhere. */
bool build(const Mesh &mesh, Triangulation &triangulation)
{
    std::stringstream medit;
    medit.precision(17);
    medit << "MeshVersionFormatted 1\nDimension 3\nVertices\n"
          << mesh.nodes.size() << '\n';
    for (const auto &xyz : mesh.nodes)
        medit << xyz[0] << ' ' << xyz[1] << ' ' << xyz[2] << " 1\n";
    medit << "Tetrahedra\n" << mesh.tets.size() << '\n';
    for (const auto &tet : mesh.tets) {
        for (std::size_t v : tet)
            medit << v + 1 << ' ';
        medit << "1\n";
    }
    medit << "End\n";
    std::stringstream report;
    std::streambuf *out = std::cout.rdbuf(report.rdbuf());
    bool built = CGAL::IO::read_MEDIT(medit, triangulation);
    std::cout.rdbuf(out);
    return built;
}

/* The mean over the edges of all tetrahedra that are no part of the exterior. */
double mean_edge_length(const Triangulation &triangulation)
{
    double sum = 0;
    std::size_t edges = 0;
    for (auto edge : triangulation.finite_edges()) {
        sum += std::sqrt(triangulation.segment(edge).squared_length());
        edges++;
    }
    return sum / static_cast<double>(edges);
}

void write_mesh(const Triangulation &triangulation)
{
    std::unordered_map<const void *, std::size_t> numbers;
    std::printf("termesh 1\n.node\n%zu 3 0 0\n", triangulation.number_of_vertices());
    for (auto v : triangulation.finite_vertex_handles()) {
        numbers[&*v] = numbers.size() + 1;
        const auto &p = v->point();
        std::printf("%zu %.17g %.17g %.17g\n", numbers.size(), p.x(), p.y(), p.z());
    }
    std::vector<Triangulation::Cell_handle> tets;
    for (auto cell : triangulation.finite_cell_handles())
        if (cell->subdomain_index() != Triangulation::Cell::Subdomain_index())
            tets.push_back(cell);
    std::printf(".ele\n%zu 4 0\n", tets.size());
    for (std::size_t t = 0; t < tets.size(); t++) {
        std::printf("%zu", t + 1);
        for (int corner = 0; corner < 4; corner++)
            std::printf(" %zu", numbers.at(&*tets[t]->vertex(corner)));
        std::printf("\n");
    }
    std::printf(".end\n");
}

double cpu_seconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

} // namespace

int main(int argc, char **argv)
{
    const double factor = argc == 3 ? std::atof(argv[1]) : 0;
    const int iterations = argc == 3 ? std::atoi(argv[2]) : 0;
    if (!(factor > 0) || iterations < 1) {
        std::fputs("usage: cgal-remesh FACTOR ITERATIONS <STREAM >STREAM\n", stderr);
        return 2;
    }
    Mesh mesh;
    Triangulation triangulation;
    if (!read_mesh(std::cin, mesh) || !build(mesh, triangulation)) {
        std::fputs("cgal-remesh: the mesh cannot be read or built\n", stderr);
        return EXIT_FAILURE;
    }
    const double length = factor * mean_edge_length(triangulation);
    const double start = cpu_seconds();
    CGAL::tetrahedral_isotropic_remeshing(
        triangulation, length,
        CGAL::parameters::remesh_boundaries(false).number_of_iterations(
            static_cast<unsigned>(iterations)));
    const double alone = cpu_seconds() - start;
    write_mesh(triangulation);
    std::fflush(stdout);
    std::fprintf(stderr, "%.4f %.4f\n", alone, cpu_seconds());
    return EXIT_SUCCESS;
}
