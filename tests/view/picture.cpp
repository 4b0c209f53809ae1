// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

namespace phantom::view::test {

std::size_t Picture::distinct_colours() const
{
    return std::set(pixels.begin(), pixels.end()).size();
}

std::size_t Picture::count(const std::function<bool(const Colour&)>& is) const
{
    return static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), [&](const auto& pixel) {
        return is({pixel[0] / 255.0, pixel[1] / 255.0, pixel[2] / 255.0});
    }));
}

Picture read_picture(const std::filesystem::path& file)
{
    vtkNew<vtkPNGReader> reader;
    if (!std::filesystem::exists(file) || reader->CanReadFile(file.c_str()) == 0)
        return {};
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkImageData* image = reader->GetOutput();
    Picture picture;
    picture.width = image->GetDimensions()[0];
    picture.height = image->GetDimensions()[1];
    const int parts = image->GetNumberOfScalarComponents();
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            std::array<unsigned char, 3> pixel{};
            for (int i = 0; i < std::min(parts, 3); ++i)
                pixel[static_cast<std::size_t>(i)] =
                    static_cast<unsigned char>(image->GetScalarComponentAsDouble(x, y, 0, i));
            picture.pixels.push_back(pixel);
        }
    }
    return picture;
}

bool has_hue(const Colour& colour, double low_deg, double high_deg, double least_saturation)
{
    const auto [low, high] = std::minmax({colour[0], colour[1], colour[2]});
    if (high <= 0 || (high - low) / high < least_saturation)
        return false;
    const double range = high - low;
    double hue = 0;
    if (high == colour[0])
        hue = 60 * (colour[1] - colour[2]) / range;
    else if (high == colour[1])
        hue = 60 * (colour[2] - colour[0]) / range + 120;
    else
        hue = 60 * (colour[0] - colour[1]) / range + 240;
    hue = std::fmod(hue + 360, 360);
    return hue >= low_deg && hue <= high_deg;
}

bool is_arrow(const Colour& colour)
{
    return has_hue(colour, 20, 32, 0.85);
}

bool is_selected(const Colour& colour)
{
    return has_hue(colour, 192, 212, 0.2);
}

bool is_strongest(const Colour& colour)
{
    return has_hue(colour, 50, 75, 0.6);
}

} // namespace phantom::view::test
