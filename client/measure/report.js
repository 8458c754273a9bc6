for (const section of document.querySelectorAll("section")) {
  const layers = [...section.querySelectorAll(".layer")];
  const tabs = [...section.querySelectorAll(".tabs button")];
  const choose = (k) => {
    layers.forEach((layer, i) => { layer.hidden = i !== k; });
    tabs.forEach((tab, i) => tab.setAttribute("aria-selected", i === k));
  };
  tabs.forEach((tab, i) => tab.addEventListener("click", () => choose(i)));
  choose(0);

  for (const layer of layers) {
    const slider = layer.querySelector(".slider");
    const errors = layer.querySelector(".errors");
    const stored = [...layer.querySelectorAll(".store img")];
    const show = () => {
      for (const side of ["left", "right"]) {
        const name = layer.querySelector("select." + side).value;
        const picture = stored.find((image) => image.dataset.name === name &&
                                               ("error" in image.dataset) === errors.checked);
        const target = slider.querySelector("img." + side);
        target.src = picture.src;
        target.alt = (errors.checked ? "Error of " : "") + name;
      }
    };
    for (const control of layer.querySelectorAll(".controls select, .controls input"))
      control.addEventListener("change", show);
    const range = slider.querySelector("input");
    range.addEventListener("input", () => slider.style.setProperty("--at", range.value + "%"));
    show();
  }
}
