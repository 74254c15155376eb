// SPDX-License-Identifier: MIT
#include "core/batch/sort_contacts.h"
#include "support/scenes.h"
#include "support/special.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

namespace voxtact::test {
namespace {

std::vector<std::uint64_t> bitsOf(const std::vector<Contact>& contacts) {
    std::vector<std::uint64_t> out;
    for (const Contact& contact : contacts) {
        out.insert(out.end(), {contact.pair, contact.triangle, static_cast<std::uint64_t>(contact.label)});
        for (const double number : {contact.position[0], contact.position[1], contact.position[2], contact.normal[0],
                                    contact.normal[1], contact.normal[2], contact.depth, contact.value}) {
            out.push_back(std::bit_cast<std::uint64_t>(number));
        }
    }
    return out;
}

TEST(SortContacts, TheOrderIsThatOfTheContactsAlone) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    constexpr double kNumbers[] = {-kInfinity, -1, 0, 2, kInfinity, kNaN, -kNaN};
    const auto any = [&] { return kNumbers[random() % std::size(kNumbers)]; };
    std::vector<Contact> contacts(600);
    for (Contact& contact : contacts) {
        contact.triangle = static_cast<std::uint32_t>(random() % 2);
        contact.position = {0, 0, static_cast<double>(random() % 2)};
        contact.value = any();
        contact.depth = any();
        contact.normal = {any(), 0, any()};
        contact.label = static_cast<std::int32_t>(random() % 2);
    }
    sortContacts(contacts);
    const std::vector<std::uint64_t> expected = bitsOf(contacts);
    for (int i = 0; i < 20; ++i) {
        std::shuffle(contacts.begin(), contacts.end(), random);
        sortContacts(contacts);
        ASSERT_EQ(bitsOf(contacts), expected);
    }
    for (std::size_t i = 1; i < contacts.size(); ++i) {
        EXPECT_LE(contacts[i - 1].triangle, contacts[i].triangle);
    }
}

} // namespace
} // namespace voxtact::test
