// Creatures as text, so that a finding can be kept, read, changed by hand and run again.
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "genes.hpp"

namespace adversary {

namespace {

void write_gene(std::string& out, const Range& range, double value) {
  if (value == range.plain) return;
  char text[64];
  // The shortest form that reads back as the same number.
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::stod(text) == value) break;
  }
  out += std::string(" ") + range.name + "=" + text;
}

template <class Gene>
void read_genes(std::istringstream& words, int count, double* genes, const std::string& line) {
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    int gene = 0;
    while (gene < count && word.substr(0, equals) != range_of(static_cast<Gene>(gene)).name) ++gene;
    if (gene == count || equals == std::string::npos)
      throw std::runtime_error("'" + word + "' is not a gene, in the line: " + line);
    genes[gene] = std::stod(word.substr(equals + 1));
  }
}

}  // namespace

std::string write_case(const Case& one) {
  std::string out = std::string(name_of(one.family));
  for (int gene = 1; gene < kWorldGenes; ++gene)
    write_gene(out, range_of(static_cast<WorldGene>(gene)), one.world[static_cast<std::size_t>(gene)]);
  out += "\n";
  for (const LinkGenes& link : one.links) {
    out += "link";
    for (int gene = 0; gene < kLinkGenes; ++gene)
      write_gene(out, range_of(static_cast<LinkGene>(gene)), link[static_cast<std::size_t>(gene)]);
    out += "\n";
  }
  return out;
}

Case read_case(const std::string& text) {
  Case made;
  for (int gene = 0; gene < kWorldGenes; ++gene)
    made.world[static_cast<std::size_t>(gene)] = range_of(static_cast<WorldGene>(gene)).plain;
  std::istringstream lines(text);
  bool known = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string first;
    if (!(words >> first)) continue;
    if (first == "link") {
      LinkGenes& link = made.links.emplace_back();
      for (int gene = 0; gene < kLinkGenes; ++gene)
        link[static_cast<std::size_t>(gene)] = range_of(static_cast<LinkGene>(gene)).plain;
      read_genes<LinkGene>(words, kLinkGenes, link.data(), line);
    } else if (family_named(first, made.family)) {
      known = true;
      read_genes<WorldGene>(words, kWorldGenes, made.world.data(), line);
    } else {
      throw std::runtime_error("a line begins with a family or with 'link', not with '" + first + "'");
    }
  }
  if (!known || made.links.empty())
    throw std::runtime_error("a case needs a line with its family and at least one link");
  made.world[kLinks] = made.count();
  return made;
}

}  // namespace adversary
