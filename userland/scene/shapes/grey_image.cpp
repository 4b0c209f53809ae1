// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes/grey_image.hpp"

#include <charconv>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <png.h>

#include "mesh/bytes.hpp"

namespace phantom::scene {

namespace {

Status check_size(std::uint64_t width, std::uint64_t height, const std::string& name)
{
    if (width >= 2 && height >= 2 && width <= image_side_max && height <= image_side_max)
        return success();
    return Error{
        name, fmt::format("has {} x {} samples, expected 2 ... {} on a side", width, height, image_side_max)};
}

/// libpng in memory. It reports errors by jumping: everything it fills lies in this object.
class PngReader {
  public:
    explicit PngReader(const std::string& bytes) : bytes_(bytes) {}
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    Result<GreyImage> read(const std::string& name)
    {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_)
            return Error{name, "cannot be read: libpng does not start"};
        if (!header())
            return Error{name, "is a damaged PNG file: " + what_};
        if (type_ != PNG_COLOR_TYPE_GRAY)
            return Error{name, "is a PNG file with colours or transparency, expected one grey channel"};
        if (Status status = check_size(width_, height_, name); !status)
            return status.error();
        if (!pixels())
            return Error{name, "is a damaged PNG file: " + what_};
        return image();
    }

  private:
    static void on_error(png_structp png, png_const_charp what)
    {
        static_cast<PngReader*>(png_get_error_ptr(png))->what_ = what;
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}
    static void on_read(png_structp png, png_bytep to, std::size_t size)
    {
        auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
        if (size > self->bytes_.size() - self->at_)
            png_error(png, "it ends early (truncated)");
        std::memcpy(to, self->bytes_.data() + self->at_, size);
        self->at_ += size;
    }

    bool header()
    {
        if (setjmp(png_jmpbuf(png_)))
            return false;
        png_set_read_fn(png_, this, on_read);
        png_set_user_limits(png_, image_side_max, image_side_max);
        png_read_info(png_, info_);
        width_ = png_get_image_width(png_, info_);
        height_ = png_get_image_height(png_, info_);
        type_ = png_get_color_type(png_, info_);
        return true;
    }

    /// After it every sample has 8 or 16 bits.
    bool pixels()
    {
        if (setjmp(png_jmpbuf(png_)))
            return false;
        png_set_expand_gray_1_2_4_to_8(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        depth_ = png_get_bit_depth(png_, info_);
        const std::size_t row_bytes = png_get_rowbytes(png_, info_);
        data_.resize(row_bytes * height_);
        rows_.resize(height_);
        for (std::size_t row = 0; row < rows_.size(); ++row)
            rows_[row] = data_.data() + row * row_bytes;
        png_read_image(png_, rows_.data());
        png_read_end(png_, nullptr);
        return true;
    }

    [[nodiscard]] GreyImage image() const
    {
        GreyImage image{width_, height_, {}};
        const std::size_t count = static_cast<std::size_t>(width_) * height_;
        image.samples.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            image.samples[i] =
                depth_ == 16 ? (256 * data_[2 * i] + data_[2 * i + 1]) / 65535.0 : data_[i] / 255.0;
        return image;
    }

    const std::string& bytes_;
    std::size_t at_ = 0;
    std::string what_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::uint32_t width_ = 0, height_ = 0;
    int type_ = 0, depth_ = 0;
    std::vector<unsigned char> data_;
    std::vector<png_bytep> rows_;
};

/// PGM (netpbm): numbers between blanks and comments, then samples.
class PgmReader {
  public:
    explicit PgmReader(const std::string& bytes) : bytes_(bytes) {}

    Result<GreyImage> read(const std::string& name)
    {
        const bool text = bytes_[1] == '2';
        const auto width = number(), height = number(), white = number();
        if (!width || !height || !white || *white < 1 || *white > 65535)
            return Error{name,
                         "is a damaged PGM file: expected width, height and a largest value up to 65535"};
        if (Status status = check_size(*width, *height, name); !status)
            return status.error();
        GreyImage image{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height), {}};
        const std::size_t count = static_cast<std::size_t>(*width) * *height;
        const std::size_t sample_bytes = *white > 255 ? 2 : 1;
        ++at_; // the one blank after the largest value
        // At least a digit and a blank each, but for the last.
        if (bytes_.size() < at_ || bytes_.size() - at_ < (text ? 2 * count - 1 : sample_bytes * count))
            return Error{name, "is a damaged PGM file: it ends early (truncated)"};
        image.samples.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = text ? number() : binary(sample_bytes);
            if (!value || *value > *white)
                return Error{name, fmt::format("is a damaged PGM file: sample {} is no number of 0 ... {}", i,
                                               *white)};
            image.samples[i] = static_cast<double>(*value) / static_cast<double>(*white);
        }
        return image;
    }

  private:
    std::optional<std::uint32_t> number()
    {
        while (at_ < bytes_.size() && (std::strchr(" \t\r\n", bytes_[at_]) || bytes_[at_] == '#')) {
            if (bytes_[at_] == '#')
                at_ = std::min(bytes_.find('\n', at_), bytes_.size());
            else
                ++at_;
        }
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(bytes_.data() + at_, bytes_.data() + bytes_.size(), value);
        if (error != std::errc{})
            return std::nullopt;
        at_ = static_cast<std::size_t>(end - bytes_.data());
        return value;
    }

    std::optional<std::uint32_t> binary(std::size_t size)
    {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
            value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
        return value;
    }

    const std::string& bytes_;
    std::size_t at_ = 2;
};

} // namespace

Result<GreyImage> read_grey_image(const std::filesystem::path& file)
{
    const auto bytes = mesh::load_bytes(file);
    if (!bytes)
        return bytes.error();
    const std::string name = file.string();
    if (bytes->starts_with("\x89PNG"))
        return PngReader(*bytes).read(name);
    if (bytes->starts_with("P2") || bytes->starts_with("P5"))
        return PgmReader(*bytes).read(name);
    return Error{name, "is neither a PNG nor a PGM file (P2, P5)"};
}

} // namespace phantom::scene
