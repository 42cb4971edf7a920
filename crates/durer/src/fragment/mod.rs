//! What happens to a fragment between the rasterizer and the framebuffer, in this order.
