-- Links between documents lead to their pages.
function Link(link)
  if not link.target:find("://") then
    link.target = link.target:gsub("%.md", ".html", 1)
  end
  return link
end
