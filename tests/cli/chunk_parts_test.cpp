// SPDX-License-Identifier: MIT
// The parts of a run in chunks: how it is cut and dealt, how contents are told apart, files that are whole or not.
#include "app/chunks/chunk_cut.h"
#include "app/chunks/content_hash.h"
#include "app/chunks/frames.h"
#include "app/chunks/run_folder.h"
#include "app/chunks/sealed_file.h"
#include "app/mpi/chunk_deck.h"
#include "cli_fixture.h"

#include <numeric>
#include <random>
#include <set>

namespace voxtact::test {
namespace {

using namespace app;

TEST(ContentHash, DoesNotDependOnHowBytesCome) {
    const auto seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (std::size_t length = 0; length < 70; ++length) {
        std::string bytes(length, '\0');
        for (char& byte : bytes) {
            byte = static_cast<char>(random());
        }
        ContentHash parts;
        for (std::size_t at = 0; at < length;) {
            const std::size_t part = std::min<std::size_t>(random() % 12, length - at);
            parts.add(std::string_view(bytes).substr(at, part));
            at += part;
        }
        EXPECT_EQ(parts.hex(), hashOf(bytes)) << length;
        EXPECT_EQ(parts.length(), length);
        EXPECT_EQ(parts.hex().size(), 32U);
    }
}

TEST(ContentHash, TellsApartWhatIsAlmostTheSame) {
    std::set<std::string> seen;
    std::size_t different = 0;
    const std::string text = "a text of some words, of which one letter is another";
    for (std::size_t byte = 0; byte < text.size(); ++byte) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            std::string other = text;
            other[byte] = static_cast<char>(other[byte] ^ (1U << bit));
            seen.insert(hashOf(other));
            ++different;
        }
    }
    // Zeros at the end, and words that changed places.
    for (std::size_t zeros = 0; zeros < 20; ++zeros) {
        seen.insert(hashOf(std::string(zeros, '\0')));
        seen.insert(hashOf(text + std::string(zeros, '\0')));
        different += 2;
    }
    seen.insert(hashOf("1234567887654321"));
    seen.insert(hashOf("8765432112345678"));
    EXPECT_EQ(seen.size(), different + 2);
}

TEST(Frames, AreToldApartHoweverTheyCome) {
    const auto seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<std::string> files;
    std::string framed;
    for (const std::size_t length :
         {std::size_t{3}, std::size_t{0}, std::size_t{400}, std::size_t{1}, std::size_t{0}}) {
        files.emplace_back(length, static_cast<char>('a' + files.size()));
        framed += frameHead(length) + files.back();
    }
    for (int way = 0; way < 50; ++way) {
        std::vector<std::string> found;
        std::size_t ended = 0;
        FrameReader reader({[&]() -> Result<void> {
                                found.emplace_back();
                                return {};
                            },
                            [&](std::string_view part) -> Result<void> {
                                found.back() += part;
                                return {};
                            },
                            [&]() -> Result<void> {
                                ++ended;
                                return {};
                            }});
        for (std::size_t at = 0; at < framed.size();) {
            const std::size_t part =
                way == 0 ? framed.size() : std::min<std::size_t>(random() % 60, framed.size() - at);
            ASSERT_TRUE(reader.add(std::string_view(framed).substr(at, part)).ok());
            EXPECT_TRUE(!reader.isBetween() || ended == found.size());
            at += part;
        }
        EXPECT_TRUE(reader.isBetween());
        EXPECT_EQ(found, files);
        EXPECT_EQ(ended, files.size());
    }
}

TEST(Frames, WhatIsNoneIsRefused) {
    const auto nothing = []() -> Result<void> { return {}; };
    const FrameReader::Files files{nothing, [](std::string_view) -> Result<void> { return {}; }, nothing};
    for (const std::string text : {"0000000000000000000x\n", "00000000000000000003abc", "-0000000000000000003\n"}) {
        EXPECT_EQ(FrameReader(files).add(text).error().code, ErrorCode::Format) << text;
    }
    FrameReader cut(files);
    EXPECT_TRUE(cut.add(frameHead(3) + "ab").ok());
    EXPECT_FALSE(cut.isBetween());
}

TEST(ChunkCut, HasEveryRowOnce) {
    for (const std::vector<std::uint64_t>& groups :
         {std::vector<std::uint64_t>{10}, {1, 1, 1}, {0, 5, 0, 0, 12, 3}, {7, 0}, {14, 7}, {1000000007}}) {
        const std::uint64_t most = groups.front() > 1000 ? 333333336 : 7;
        const ChunkCut cut(groups, most);
        std::vector<std::uint64_t> next(groups.size(), 0);
        for (std::uint64_t chunk = 0; chunk < cut.chunks(); ++chunk) {
            const ChunkRange range = cut.at(chunk);
            EXPECT_EQ(range.number, chunk);
            EXPECT_EQ(range.first, next[range.group]);
            EXPECT_GE(range.count, 1U);
            EXPECT_LE(range.count, most);
            next[range.group] += range.count;
        }
        EXPECT_EQ(next, groups);
    }
}

TEST(ChunkCut, ShardsHaveEveryChunkOnce) {
    for (const std::uint64_t chunks : {0ULL, 1ULL, 6ULL, 7ULL, 100ULL, 10000019ULL}) {
        for (const std::uint32_t count : {1U, 2U, 7U, 100U, 4294967295U}) {
            std::uint64_t next = 0;
            for (std::uint32_t index = 1; index <= std::min(count, 200U); ++index) {
                const auto [begin, end] = chunksOf({index, count}, chunks);
                EXPECT_EQ(begin, next);
                EXPECT_LE(end - begin, chunks / count + 1);
                next = end;
            }
            EXPECT_EQ(chunksOf({count, count}, chunks).second, chunks);
        }
    }
}

TEST(ChunkDeck, KeepsRanksWithTheirGroups) {
    // Chunks of 10 rows: four of the first group, two of the second, and of the third two, one of which is there.
    const ChunkCut cut({40, 20, 15}, 10);
    ChunkDeck deck(cut, {0, 1, 2, 3, 4, 5, 7});
    EXPECT_EQ(deck.deal(0), 0U);
    EXPECT_EQ(deck.deal(1), 4U) << "15 rows for each of two would be left in the first group: 20 in the second";
    EXPECT_EQ(deck.deal(2), 1U) << "15 for each of two, 10 of the second for two, 5 of the third";
    EXPECT_EQ(deck.deal(1), 5U) << "it stays";
    EXPECT_EQ(deck.deal(1), 2U) << "nothing is left there: 20 rows for three, 5 for one";
    EXPECT_EQ(deck.deal(0), 3U);
    EXPECT_EQ(deck.deal(2), 7U);
    for (const int rank : {0, 1, 2, 3, 0}) {
        EXPECT_EQ(deck.deal(rank), std::nullopt);
    }
    ChunkDeck empty(cut, {});
    EXPECT_EQ(empty.deal(0), std::nullopt);
}

TEST(ChunkDeck, DealsEachChunkOnce) {
    const auto seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const ChunkCut cut({100, 3, 57, 0, 12}, 5);
    std::vector<std::uint64_t> all(cut.chunks());
    std::iota(all.begin(), all.end(), 0U);
    ChunkDeck deck(cut, all);
    std::set<std::uint64_t> dealt;
    while (const auto chunk = deck.deal(static_cast<int>(random() % 4))) {
        EXPECT_TRUE(dealt.insert(*chunk).second) << *chunk;
    }
    EXPECT_EQ(dealt.size(), cut.chunks());
}

TEST(DeviceOfRank, GivesEachRankAGpuOfItsOwn) {
    EXPECT_EQ(deviceOfRank({}, 0), std::nullopt);
    EXPECT_EQ(deviceOfRank({false, false}, 1), std::nullopt);
    EXPECT_EQ(deviceOfRank({false, true}, 1), std::nullopt) << "one GPU is what there is";
    const std::vector<bool> several{true, false, true, true};
    const std::vector<std::size_t> expected{0, 2, 3, 0, 2};
    for (int rank = 0; rank < 5; ++rank) {
        EXPECT_EQ(deviceOfRank(several, rank), expected[static_cast<std::size_t>(rank)]);
    }
}

class SealedFile : public CliTest {
  protected:
    void write(const std::string& content) {
        Result<ResultFile> file = ResultFile::createSealed(path("file"), "what it is");
        ASSERT_TRUE(file.ok());
        std::filesystem::remove(path("file"));
        // In parts that are shorter, and longer, than any buffer.
        const std::size_t half = content.size() / 2;
        file->stream() << content.substr(0, half);
        for (const char c : content.substr(half)) {
            file->stream().put(c);
        }
        EXPECT_TRUE(file->close().ok());
        EXPECT_FALSE(std::filesystem::exists(path("file")));
        EXPECT_TRUE(file->commit().ok());
    }
};

TEST_F(SealedFile, GivesBackWhatWasWritten) {
    for (const std::size_t length : {0U, 1U, 100U, 65536U, 200001U}) {
        std::string content(length, 'x');
        for (std::size_t i = 0; i < length; ++i) {
            content[i] = static_cast<char>(i * i % 251);
        }
        write(content);
        std::string back;
        EXPECT_EQ(readSealed(path("file"), "what it is", [&](std::string_view part) { back += part; }),
                  SealState::Whole);
        EXPECT_EQ(back, content);
    }
}

TEST_F(SealedFile, KnowsWhatIsNotWhole) {
    EXPECT_EQ(readSealed(path("file"), "what it is"), SealState::Missing);
    write("some content\nof two lines");
    EXPECT_EQ(readSealed(path("file"), "what it was"), SealState::Damaged);
    EXPECT_EQ(readSealed(path("file"), "what"), SealState::Damaged);
    const std::string whole = readText(path("file"));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        writeText(path("file"), whole.substr(0, length));
        EXPECT_EQ(readSealed(path("file"), "what it is"), SealState::Damaged) << length;
        std::string changed = whole;
        changed[length] = static_cast<char>(changed[length] ^ 2);
        writeText(path("file"), changed);
        EXPECT_EQ(readSealed(path("file"), "what it is"), SealState::Damaged) << length;
    }
    writeText(path("file"), whole + "\n");
    EXPECT_EQ(readSealed(path("file"), "what it is"), SealState::Damaged);
    std::filesystem::remove(path("file"));
    std::filesystem::create_directory(path("file"));
    EXPECT_EQ(readSealed(path("file"), "what it is"), SealState::Damaged);
}

} // namespace
} // namespace voxtact::test
