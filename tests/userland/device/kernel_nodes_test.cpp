// SPDX-License-Identifier: GPL-2.0-or-later
// Which nodes of the kernel's module there are, by the names in a folder like /sys/class/phantom_rt.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <cstdlib>

#include <gtest/gtest.h>

#include "device/device.hpp"

namespace phantom::test {
namespace {

class KernelNodes : public ::testing::Test {
  protected:
    KernelNodes()
    {
        char name[] = "/tmp/phantom_nodes_XXXXXX";
        folder_ = ::mkdtemp(name);
    }
    ~KernelNodes() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

TEST_F(KernelNodes, AreListedByNumber)
{
    for (const char* name : {"phantom_rt10", "phantom_rt2", "phantom_rt0", "phantom0", "phantom_rt",
                             "phantom_rtx", "phantom_rt1x", "phantom_rt99999999999999999999"})
        std::filesystem::create_directory(folder_ / name);
    EXPECT_EQ(device::kernel_nodes(folder_),
              (std::vector<std::string>{"/dev/phantom_rt0", "/dev/phantom_rt2", "/dev/phantom_rt10"}));
}

TEST_F(KernelNodes, WithoutAnyTheFirstIsNamed)
{
    EXPECT_EQ(device::kernel_nodes(folder_), std::vector<std::string>{"/dev/phantom_rt0"});
    EXPECT_EQ(device::kernel_nodes(folder_ / "none"), std::vector<std::string>{"/dev/phantom_rt0"});
}

TEST_F(KernelNodes, AMissingOneIsToldWithWhatToDo)
{
    const auto device = device::Device::open_kernel(device::Access::observer, "/dev/phantom_rt77");
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().where, "/dev/phantom_rt77");
    EXPECT_NE(device.error().what.find("no such device"), std::string::npos);
    EXPECT_FALSE(device.error().remedy.empty());
}

TEST_F(KernelNodes, AFileThatIsNoDeviceIsRefused)
{
    const std::filesystem::path file = folder_ / "phantom_rt0";
    std::ofstream(file) << "x";
    const auto device = device::Device::open_kernel(device::Access::observer, file.string());
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().where, file.string());
}

} // namespace
} // namespace phantom::test
