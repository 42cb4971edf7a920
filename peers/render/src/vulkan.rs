//! A Vulkan device in a shared library, with the functions needed to draw frames of one mesh.
//!
//! Every call is unsafe by Vulkan's nature. All of them meet these conditions: handles come from the device that they
//! are passed to and live until it is destroyed, structures point to locals that outlive the call, one thread makes the
//! calls, and each submission is complete before its data are used again.

use crate::{Result, scene};
use ash::vk;
use std::path::Path;

const EXTENT: vk::Extent2D =
    vk::Extent2D { width: scene::WIDTH as u32, height: scene::HEIGHT as u32 };
const COLOR: vk::Format = vk::Format::R8G8B8A8_UNORM;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
/// Two matrices, which every Vulkan device takes.
const MATRIX_BYTES: u32 = 128;

/// A device with a queue.
pub struct Gpu {
    /// Name of the device.
    pub name: String,
    device: ash::Device,
    instance: ash::Instance,
    queue: vk::Queue,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    memory_types: vk::PhysicalDeviceMemoryProperties,
    buffers: Vec<vk::Buffer>,
    images: Vec<(vk::Image, vk::ImageView)>,
    memory: Vec<vk::DeviceMemory>,
    pipeline: Option<(vk::Pipeline, vk::PipelineLayout)>,
    // Last: unloads the library.
    _entry: ash::Entry,
}

/// Targets of a frame; without multisampling, it is drawn to `resolved`.
pub struct Targets {
    samples: u32,
    color: vk::ImageView,
    depth: vk::ImageView,
    resolved: (vk::Image, vk::ImageView),
}

impl Gpu {
    /// Creates the first device of the library, by Vulkan 1.3.
    pub fn new(library: &Path) -> Result<Self> {
        // SAFETY: loading a Vulkan library runs its constructors, which ask nothing of the caller.
        let entry = unsafe { ash::Entry::load_from(library)? };
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: see the head of the file; so in all that follows.
        let instance = unsafe { entry.create_instance(&info, None)? };
        let physical = unsafe { instance.enumerate_physical_devices()? };
        let physical = *physical.first().ok_or("a Vulkan library without devices")?;
        let properties = unsafe { instance.get_physical_device_properties(physical) };
        let name = properties.device_name_as_c_str()?.to_string_lossy().into_owned();
        let memory_types = unsafe { instance.get_physical_device_memory_properties(physical) };
        let device = device(&instance, physical)?;
        let queue = unsafe { device.get_device_queue(0, 0) };
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let pool = unsafe { device.create_command_pool(&info, None)? };
        let info =
            vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        let commands = unsafe { device.allocate_command_buffers(&info)? }[0];
        let fence = unsafe { device.create_fence(&vk::FenceCreateInfo::default(), None)? };
        Ok(Self {
            name,
            device,
            instance,
            queue,
            pool,
            commands,
            fence,
            memory_types,
            buffers: Vec::new(),
            images: Vec::new(),
            memory: Vec::new(),
            pipeline: None,
            _entry: entry,
        })
    }

    /// Returns memory that the host can write and read; a software device has no other.
    fn allocate(&mut self, needs: vk::MemoryRequirements) -> Result<vk::DeviceMemory> {
        let wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let types = self.memory_types.memory_types_as_slice().iter().zip(0..);
        let index = types
            .filter(|(_, i)| needs.memory_type_bits >> i & 1 == 1)
            .find_map(|(t, i)| t.property_flags.contains(wanted).then_some(i))
            .ok_or("no memory that the host can see")?;
        let info =
            vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(index);
        let memory = unsafe { self.device.allocate_memory(&info, None)? };
        self.memory.push(memory);
        Ok(memory)
    }

    fn buffer_of(
        &mut self,
        size: usize,
        usage: vk::BufferUsageFlags,
    ) -> Result<(vk::Buffer, vk::DeviceMemory)> {
        let info = vk::BufferCreateInfo::default().size(size as u64).usage(usage);
        let buffer = unsafe { self.device.create_buffer(&info, None)? };
        self.buffers.push(buffer);
        let needs = unsafe { self.device.get_buffer_memory_requirements(buffer) };
        let memory = self.allocate(needs)?;
        unsafe { self.device.bind_buffer_memory(buffer, memory, 0)? };
        Ok((buffer, memory))
    }

    /// Creates a buffer with the given words.
    pub fn buffer(&mut self, words: &[u32], usage: vk::BufferUsageFlags) -> Result<vk::Buffer> {
        let (buffer, memory) = self.buffer_of(size_of_val(words), usage)?;
        let flags = vk::MemoryMapFlags::empty();
        // SAFETY: the mapping is as long as the words, aligned for any type, and ours alone.
        unsafe {
            let to = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, flags)?;
            std::ptr::copy_nonoverlapping(words.as_ptr(), to.cast(), words.len());
            self.device.unmap_memory(memory);
        }
        Ok(buffer)
    }

    fn image(
        &mut self,
        format: vk::Format,
        samples: u32,
        usage: vk::ImageUsageFlags,
    ) -> Result<(vk::Image, vk::ImageView)> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(EXTENT.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::from_raw(samples))
            .usage(usage);
        let image = unsafe { self.device.create_image(&info, None)? };
        let needs = unsafe { self.device.get_image_memory_requirements(image) };
        let memory = self.allocate(needs)?;
        unsafe { self.device.bind_image_memory(image, memory, 0)? };
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(whole(format));
        let view = unsafe { self.device.create_image_view(&info, None)? };
        self.images.push((image, view));
        self.submit(|gpu| gpu.to_general(image, format))?;
        Ok((image, view))
    }

    /// Creates targets with 8-bit colour, 32-bit depth and a number of samples.
    pub fn targets(&mut self, samples: u32) -> Result<Targets> {
        let drawn = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        let read = drawn | vk::ImageUsageFlags::TRANSFER_SRC;
        let resolved = self.image(COLOR, 1, read)?;
        let color = if samples == 1 { resolved } else { self.image(COLOR, samples, drawn)? };
        let depth = self.image(DEPTH, samples, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT)?;
        Ok(Targets { samples, color: color.1, depth: depth.1, resolved })
    }

    /// The one layout that all use of an image allows.
    fn to_general(&self, image: vk::Image, format: vk::Format) {
        let barrier = vk::ImageMemoryBarrier::default()
            .image(image)
            .new_layout(vk::ImageLayout::GENERAL)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
            .subresource_range(whole(format));
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let none = vk::DependencyFlags::empty();
        unsafe {
            self.device.cmd_pipeline_barrier(self.commands, all, all, none, &[], &[], &[barrier]);
        }
    }

    /// Records commands, has them done and waits until they are.
    fn submit(&self, record: impl FnOnce(&Self)) -> Result<()> {
        let once = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        let buffers = [self.commands];
        let info = vk::SubmitInfo::default().command_buffers(&buffers);
        unsafe {
            self.device.begin_command_buffer(self.commands, &once)?;
            record(self);
            self.device.end_command_buffer(self.commands)?;
            self.device.queue_submit(self.queue, &[info], self.fence)?;
            self.device.wait_for_fences(&[self.fence], true, u64::MAX)?;
            self.device.reset_fences(&[self.fence])?;
        }
        Ok(())
    }

    /// Sets up drawing of triangles with depth test and without back faces: vertices of a position
    /// and a normal, matrices as push constants, shaders as [`crate::shaders::phong`] gives them.
    pub fn pipeline(&mut self, shaders: &[Vec<u32>; 2], samples: u32) -> Result<()> {
        let ranges = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::VERTEX)
            .size(MATRIX_BYTES)];
        let info = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(&ranges);
        let layout = unsafe { self.device.create_pipeline_layout(&info, None)? };
        let modules = [self.shader(&shaders[0])?, self.shader(&shaders[1])?];
        let pipeline = self.make_pipeline(layout, modules, samples);
        for module in modules {
            unsafe { self.device.destroy_shader_module(module, None) };
        }
        self.pipeline = Some((pipeline?, layout));
        Ok(())
    }

    fn shader(&self, words: &[u32]) -> Result<vk::ShaderModule> {
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        Ok(unsafe { self.device.create_shader_module(&info, None)? })
    }

    fn make_pipeline(
        &self,
        layout: vk::PipelineLayout,
        [vertex, fragment]: [vk::ShaderModule; 2],
        samples: u32,
    ) -> Result<vk::Pipeline> {
        let stage = |stage, module, name| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(name)
        };
        let stages = [
            stage(vk::ShaderStageFlags::VERTEX, vertex, c"vertex"),
            stage(vk::ShaderStageFlags::FRAGMENT, fragment, c"fragment"),
        ];
        let bindings = [vk::VertexInputBindingDescription::default().stride(24)];
        let attribute = |location, offset| vk::VertexInputAttributeDescription {
            location,
            binding: 0,
            format: vk::Format::R32G32B32_SFLOAT,
            offset,
        };
        let attributes = [attribute(0, 0), attribute(1, 12)];
        let input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        // Of negative height: y goes up, as in OpenGL.
        let (width, height) = (EXTENT.width as f32, EXTENT.height as f32);
        let viewports = [vk::Viewport {
            x: 0.0,
            y: height,
            width,
            height: -height,
            min_depth: 0.0,
            max_depth: 1.0,
        }];
        let scissors = [EXTENT.into()];
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewports(&viewports)
            .scissors(&scissors);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(vk::CullModeFlags::BACK)
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::from_raw(samples));
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(vk::CompareOp::LESS);
        let blends = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let formats = [COLOR];
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(DEPTH);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .layout(layout)
            .push_next(&mut rendering);
        let cache = vk::PipelineCache::null();
        let made = unsafe { self.device.create_graphics_pipelines(cache, &[info], None) };
        Ok(made.map_err(|(_, e)| e)?[0])
    }

    /// Draws a complete frame: the background, then the triangles of the indices.
    pub fn draw(
        &self,
        targets: &Targets,
        [vertices, indices]: [vk::Buffer; 2],
        count: u32,
        matrices: &[u8; MATRIX_BYTES as usize],
    ) -> Result<()> {
        let (pipeline, layout) = self.pipeline.ok_or("drawn without a pipeline")?;
        let (device, commands) = (&self.device, self.commands);
        self.submit(|_| unsafe {
            targets.begin(device, commands);
            device.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, pipeline);
            device.cmd_bind_vertex_buffers(commands, 0, &[vertices], &[0]);
            device.cmd_bind_index_buffer(commands, indices, 0, vk::IndexType::UINT32);
            let stage = vk::ShaderStageFlags::VERTEX;
            device.cmd_push_constants(commands, layout, stage, 0, matrices);
            device.cmd_draw_indexed(commands, count, 1, 0, 0, 0);
            device.cmd_end_rendering(commands);
        })
    }

    /// Returns the pixels of the last frame, rows from the top.
    pub fn read(&mut self, targets: &Targets) -> Result<Vec<[u8; 4]>> {
        let count = scene::WIDTH * scene::HEIGHT;
        let (buffer, memory) = self.buffer_of(4 * count, vk::BufferUsageFlags::TRANSFER_DST)?;
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .layer_count(1);
        let region =
            vk::BufferImageCopy::default().image_subresource(layers).image_extent(EXTENT.into());
        self.submit(|gpu| {
            gpu.visible();
            let (image, layout) = (targets.resolved.0, vk::ImageLayout::GENERAL);
            let regions = [region];
            unsafe {
                gpu.device.cmd_copy_image_to_buffer(gpu.commands, image, layout, buffer, &regions);
            }
            gpu.visible();
        })?;
        let flags = vk::MemoryMapFlags::empty();
        // SAFETY: the mapping has room for the pixels, which the device has written, and any bytes are valid pixels.
        unsafe {
            let from = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, flags)?;
            let pixels = std::slice::from_raw_parts(from.cast::<[u8; 4]>(), count).to_vec();
            self.device.unmap_memory(memory);
            Ok(pixels)
        }
    }

    /// Waits until earlier writes are visible to everything after.
    fn visible(&self) {
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ);
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let none = vk::DependencyFlags::empty();
        let to = all | vk::PipelineStageFlags::HOST;
        unsafe {
            self.device.cmd_pipeline_barrier(self.commands, all, to, none, &[barrier], &[], &[]);
        }
    }
}

/// Returns a device with one queue and rendering without render passes.
fn device(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<ash::Device> {
    let queues =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
    let mut features = vk::PhysicalDeviceVulkan13Features::default().dynamic_rendering(true);
    let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).push_next(&mut features);
    // SAFETY: see the head of the file.
    Ok(unsafe { instance.create_device(physical, &info, None)? })
}

fn whole(format: vk::Format) -> vk::ImageSubresourceRange {
    let aspect =
        if format == DEPTH { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
    vk::ImageSubresourceRange::default().aspect_mask(aspect).level_count(1).layer_count(1)
}

impl Targets {
    /// Begins with the background and the far plane; of many samples, only their mean is kept.
    fn begin(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        let [r, g, b] = scene::BACKGROUND;
        let color = vk::ClearValue { color: vk::ClearColorValue { float32: [r, g, b, 1.0] } };
        let far = vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 };
        let general = vk::ImageLayout::GENERAL;
        let mut color = vk::RenderingAttachmentInfo::default()
            .image_view(self.color)
            .image_layout(general)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(color);
        if self.samples > 1 {
            color = color
                .store_op(vk::AttachmentStoreOp::DONT_CARE)
                .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                .resolve_image_view(self.resolved.1)
                .resolve_image_layout(general);
        }
        let colors = [color];
        let depth = vk::RenderingAttachmentInfo::default()
            .image_view(self.depth)
            .image_layout(general)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::DONT_CARE)
            .clear_value(vk::ClearValue { depth_stencil: far });
        let info = vk::RenderingInfo::default()
            .render_area(EXTENT.into())
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        // SAFETY: see the head of the file.
        unsafe { device.cmd_begin_rendering(commands, &info) };
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        let device = &self.device;
        // SAFETY: all is this device's own, and nothing of it is at work: submissions are waited for.
        unsafe {
            if let Some((pipeline, layout)) = self.pipeline {
                device.destroy_pipeline(pipeline, None);
                device.destroy_pipeline_layout(layout, None);
            }
            for &(image, view) in &self.images {
                device.destroy_image_view(view, None);
                device.destroy_image(image, None);
            }
            self.buffers.iter().for_each(|&b| device.destroy_buffer(b, None));
            self.memory.iter().for_each(|&m| device.free_memory(m, None));
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
            device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}
