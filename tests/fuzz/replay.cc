// Runs a fuzz target without libFuzzer, which takes clang: every seed as it is, cut short, and changed at random, the
// same way each time. What is no finding ends with a line of how much ran.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

constexpr size_t kCuts = 64;     // of each seed
constexpr int kMutations = 200;  // of each seed
constexpr int kMostChanges = 6;  // of each mutation

class Replay {
 public:
  explicit Replay(std::vector<Bytes> seeds) : seeds_(std::move(seeds)) {}

  size_t run() {
    for (const Bytes& seed : seeds_) {
      run_one(seed);
      for (size_t cut = 0; cut < kCuts; ++cut) run_one({seed.begin(), seed.begin() + cut_at(seed, cut)});
      for (int i = 0; i < kMutations; ++i) run_one(mutated(seed));
    }
    return runs_;
  }

 private:
  // A copy of its very size, so that a sanitizer sees every step past its end.
  void run_one(const Bytes& bytes) {
    const Bytes exact(bytes.begin(), bytes.end());
    LLVMFuzzerTestOneInput(exact.data(), exact.size());
    ++runs_;
  }

  static std::ptrdiff_t cut_at(const Bytes& seed, size_t cut) {
    return static_cast<std::ptrdiff_t>(seed.size() * cut / kCuts);
  }

  size_t below(size_t limit) { return std::uniform_int_distribution<size_t>(0, limit - 1)(random_); }

  Bytes mutated(Bytes bytes) {
    static constexpr uint8_t kEdges[] = {0x00, 0x7f, 0x80, 0xff, '-', '9', ',', '\n'};
    for (size_t changes = 1 + below(kMostChanges); changes > 0 && !bytes.empty(); --changes) {
      const size_t at = below(bytes.size());
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
      switch (below(5)) {
        case 0:
          bytes[at] ^= static_cast<uint8_t>(1u << below(8));
          break;
        case 1:
          bytes[at] = kEdges[below(std::size(kEdges))];
          break;
        case 2:
          bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(1 + below(std::min<size_t>(8, bytes.size() - at))));
          break;
        case 3:
          bytes.insert(begin, 1 + below(8), kEdges[below(std::size(kEdges))]);
          break;
        default: {  // the end of another seed
          const Bytes& other = seeds_[below(seeds_.size())];
          bytes.resize(at);
          if (!other.empty())
            bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(below(other.size())), other.end());
        }
      }
    }
    return bytes;
  }

  std::vector<Bytes> seeds_;
  std::mt19937 random_{1};
  size_t runs_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::vector<fs::path> files;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : fs::directory_iterator(argv[i])) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Bytes> seeds;
  for (const fs::path& path : files) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  if (seeds.empty()) {
    std::cerr << "no seeds\n";
    return 1;
  }
  const size_t count = seeds.size();
  std::cout << Replay(std::move(seeds)).run() << " inputs made of " << count << " seeds\n";
}
